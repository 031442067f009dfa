#include "work.h"

void regression_for_each_row(struct works *works, ps_body body)
{
    const ps_host *host = works->of[0].host;
    for (int i = 0; i < works->count; i++)
        host->parallel_for(host, works->of[i].height, body, &works->of[i]);
}

static void fit_all(struct works *works, int bandwidth, work_planes from, work_planes to,
                    const struct regression_steering *steering)
{
    float *values[REGRESSION_MOST], *fitted[REGRESSION_MOST];
    for (int i = 0; i < works->count; i++)
        for (int c = 0; c < VALUES; c++) {
            values[i * VALUES + c] = from(&works->of[i])[c];
            fitted[i * VALUES + c] = to(&works->of[i])[c];
        }
    regression_fit(&works->of[0].guides, bandwidth, works->count * VALUES, values, steering,
                   fitted);
}

void regression_fit_all(struct works *works, int bandwidth, work_planes from, work_planes to)
{
    fit_all(works, bandwidth, from, to, NULL);
}

void regression_fit_steered(struct works *works, int bandwidth, work_planes from, work_planes to)
{
    struct regression_steering steering[REGRESSION_IMAGES];
    for (int i = 0; i < works->count; i++)
        steering[i] = (struct regression_steering){works->of[i].sum, works->of[i].least};
    fit_all(works, bandwidth, from, to, steering);
}
