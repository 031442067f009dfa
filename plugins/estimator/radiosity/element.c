#include "element.h"

void element_measure(struct element *element)
{
    const ps_vec3 *corners = element->corners;
    element->centre = ps_scale(ps_add(ps_add(corners[0], corners[1]), corners[2]), 1.0f / 3.0f);
    element->radius = 0.0f;
    for (int i = 0; i < 3; i++)
        element->radius =
            ps_max(element->radius, ps_length(ps_subtract(corners[i], element->centre)));
}

bool elements_divide(struct elements *elements, uint32_t index)
{
    if (elements->tree.count > UINT32_MAX - 8 ||
        !array_reserve(elements->host, &elements->tree, 4, sizeof(struct element),
                       "radiosity elements"))
        return false;
    struct element *whole = elements_at(elements, index);
    static const uint8_t parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {4, 5, 3}};
    ps_vec3 points[6];
    float places[6][2];
    for (int i = 0; i < 3; i++) {
        int next = (i + 1) % 3;
        points[i] = whole->corners[i];
        points[3 + i] = ps_scale(ps_add(whole->corners[i], whole->corners[next]), 0.5f);
        for (int k = 0; k < 2; k++) {
            places[i][k] = whole->places[i][k];
            places[3 + i][k] = 0.5f * (whole->places[i][k] + whole->places[next][k]);
        }
    }
    whole->child = (uint32_t)elements->tree.count;
    whole->child_count = 4;
    for (int part = 0; part < 4; part++) {
        struct element *child = elements_at(elements, elements->tree.count++);
        *child = *whole;
        child->parent = index;
        child->child_count = 0;
        child->area = 0.25f * whole->area;
        for (int i = 0; i < 3; i++) {
            child->corners[i] = points[parts[part][i]];
            memcpy(child->places[i], places[parts[part][i]], sizeof child->places[i]);
        }
        element_measure(child);
    }
    return true;
}

void elements_release(struct elements *elements)
{
    if (!elements->host)
        return;
    elements->host->release(elements->host, elements->tree.items);
    elements->host->release(elements->host, elements->sides);
    *elements = (struct elements){.host = NULL};
}
