/* flip_colour.c: FLIP's colour pipeline (section 4.1 of the paper).
 *
 * XYZ -> YCxCz, an opponent space linear in light; filters after the eye's contrast sensitivity
 * remove what it can't resolve; back to RGB to clip, then to L*a*b*, its chroma scaled by lightness
 * (Hunt: colours look duller in the dark); then the HyAB distance |dL| + |(da, db)|, which suits
 * large differences; then a redistribution onto 0..1 that spends most of the range on the smaller
 * ones.
 */
#include "compare/filter.h"
#include "compare/flip.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Exponent, and redistribution: differences below PC of the largest take PT of the range. */
#define QC 0.7
#define PC 0.4
#define PT 0.95

/* Contrast sensitivity as a sum of Gaussians in space, a sqrt(pi/b) exp(-pi^2 x^2 / b), x in
 * degrees (table 1): achromatic, red-green, blue-yellow. */
struct sensitivity {
    int gaussians;
    double a[2], b[2];
};
static const struct sensitivity sensitivities[3] = {
    {1, {1.0}, {0.0047}},
    {1, {1.0}, {0.0053}},
    {2, {34.1, 13.5}, {0.04, 0.025}},
};
#define WIDEST_B 0.04 /* decides all filters' radius */

/* The sum of each row is the white point, D65. */
static const double xyz_of_rgb[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
};
static const double rgb_of_xyz[3][3] = {
    {3.241003275, -1.537398934, -0.498615861},
    {-0.969224334, 1.875930071, 0.041554224},
    {0.055639423, -0.204011202, 1.057148933},
};
static const double white[3] = {0.950428545, 1.0, 1.088900371};

static void multiply(const double matrix[3][3], const double in[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = matrix[i][0] * in[0] + matrix[i][1] * in[1] + matrix[i][2] * in[2];
}

void flip_xyz_from_rgb(const double rgb[3], double xyz[3])
{
    multiply(xyz_of_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++)
        xyz[i] /= white[i];
}

void flip_rgb_from_xyz(const double xyz[3], double rgb[3])
{
    const double absolute[3] = {xyz[0] * white[0], xyz[1] * white[1], xyz[2] * white[2]};
    multiply(rgb_of_xyz, absolute, rgb);
}

/* The step that YCxCz and L*a*b* share; they differ in what they are taken of. */
static void opponent_from_xyz(const double xyz[3], double opponent[3])
{
    opponent[0] = 116.0 * xyz[1] - 16.0;
    opponent[1] = 500.0 * (xyz[0] - xyz[1]);
    opponent[2] = 200.0 * (xyz[1] - xyz[2]);
}

static void xyz_from_opponent(const double opponent[3], double xyz[3])
{
    xyz[1] = (opponent[0] + 16.0) / 116.0;
    xyz[0] = xyz[1] + opponent[1] / 500.0;
    xyz[2] = xyz[1] - opponent[2] / 200.0;
}

/* CIE 1976: the cube root, and its tangent below (6/29)^3. */
static double lightness_curve(double value)
{
    const double delta = 6.0 / 29.0;
    return value > delta * delta * delta ? cbrt(value) : value / (3.0 * delta * delta) + 4.0 / 29.0;
}

static void hunt_lab_from_xyz(const double xyz[3], double lab[3])
{
    const double curved[3] = {lightness_curve(xyz[0]), lightness_curve(xyz[1]),
                              lightness_curve(xyz[2])};
    opponent_from_xyz(curved, lab);
    lab[1] *= 0.01 * lab[0];
    lab[2] *= 0.01 * lab[0];
}

/* Both Gaussians are separable, but not their sum: they are applied apart and added by their share
 * of the kernel's sum, a sqrt(pi/b) S^2 with S the sum of the one-dimensional taps. */
static void filter_by_sensitivity(double *plane, size_t width, size_t height,
                                  const struct sensitivity *sensitivity,
                                  double *const scratch[FLIP_SCRATCH_PLANES],
                                  struct workers *workers)
{
    int radius = (int)ceil(3.0 * sqrt(WIDEST_B / (2.0 * PI * PI)) * FLIP_PIXELS_PER_DEGREE);
    double shares[2] = {1.0, 0.0}, *out[2] = {scratch[1], plane};
    struct filter filters[2];
    for (int g = 0; g < sensitivity->gaussians; g++) {
        double sigma = sqrt(sensitivity->b[g] / (2.0 * PI * PI)) * FLIP_PIXELS_PER_DEGREE;
        filters[g] = filter_gaussian(sigma, radius);
        double taps = 1.0 / filters[g].weights[radius]; /* the middle tap is 1 / S */
        shares[g] = sensitivity->a[g] * sqrt(PI / sensitivity->b[g]) * taps * taps;
    }
    if (sensitivity->gaussians == 1) {
        filter_plane(plane, width, height, &filters[0], &filters[0], scratch[0], plane, workers);
        return;
    }
    for (int g = 0; g < 2; g++)
        filter_plane(plane, width, height, &filters[g], &filters[g], scratch[0], out[g], workers);
    double share = shares[0] / (shares[0] + shares[1]);
    for (size_t i = 0; i < width * height; i++)
        plane[i] = share * scratch[1][i] + (1.0 - share) * plane[i];
}

void flip_colour_perceived(double *const planes[3], size_t width, size_t height,
                           double *const scratch[FLIP_SCRATCH_PLANES], struct workers *workers)
{
    double xyz[3], opponent[3], rgb[3], lab[3];
    for (size_t i = 0; i < width * height; i++) {
        for (int c = 0; c < 3; c++)
            xyz[c] = planes[c][i];
        opponent_from_xyz(xyz, opponent);
        for (int c = 0; c < 3; c++)
            planes[c][i] = opponent[c];
    }
    for (int c = 0; c < 3; c++)
        filter_by_sensitivity(planes[c], width, height, &sensitivities[c], scratch, workers);
    for (size_t i = 0; i < width * height; i++) {
        for (int c = 0; c < 3; c++)
            opponent[c] = planes[c][i];
        xyz_from_opponent(opponent, xyz);
        flip_rgb_from_xyz(xyz, rgb);
        for (int c = 0; c < 3; c++)
            rgb[c] = fmin(fmax(rgb[c], 0.0), 1.0);
        flip_xyz_from_rgb(rgb, xyz);
        hunt_lab_from_xyz(xyz, lab);
        for (int c = 0; c < 3; c++)
            planes[c][i] = lab[c];
    }
}

static double distance_hyab(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

double flip_colour_largest_distance(void)
{
    double xyz[3], green[3], blue[3];
    flip_xyz_from_rgb((const double[3]){0.0, 1.0, 0.0}, xyz);
    hunt_lab_from_xyz(xyz, green);
    flip_xyz_from_rgb((const double[3]){0.0, 0.0, 1.0}, xyz);
    hunt_lab_from_xyz(xyz, blue);
    return distance_hyab(green, blue);
}

double flip_colour_difference(const double reference[3], const double test[3],
                              double largest_distance)
{
    double largest = pow(largest_distance, QC);
    double difference = pow(distance_hyab(reference, test), QC);
    double knee = PC * largest;
    if (difference < knee)
        return PT / knee * difference;
    return PT + (difference - knee) / (largest - knee) * (1.0 - PT);
}
