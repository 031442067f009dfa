#include "image/magnify.h"

#include <string.h>

void magnify(const uint8_t *rgb, size_t width, struct rectangle part, size_t zoom,
             uint8_t *magnified)
{
    size_t columns = part.width * zoom;
    for (size_t y = 0; y < part.height * zoom; y++) {
        const uint8_t *row = rgb + 3 * ((part.y + y / zoom) * width + part.x);
        for (size_t x = 0; x < columns; x++)
            memcpy(magnified + 3 * (y * columns + x), row + 3 * (x / zoom), 3);
    }
}
