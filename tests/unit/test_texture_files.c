/* test_texture_files.c: every kind of file that can be read, made byte by byte or by another
 * program (tests/data); those that are refused; damaged ones.
 *
 * The PNG pictures are 3 x 2, the JPEG ones 32 x 32 of four plain quarters. */
#include "image/raster_decode.h"
#include "texture_fixture.h"

/* From the formula of IEC 61966-2-1, spelled out anew. */
static float decoded(double code)
{
    return (float)(code <= 0.04045 ? code / 12.92 : pow((code + 0.055) / 1.055, 2.4));
}

static int colors[6][3] = {{255, 0, 0}, {0, 255, 0},   {0, 0, 255},
                           {0, 0, 0},   {128, 64, 32}, {255, 255, 255}};
static const int greys[6] = {0, 50, 100, 150, 200, 255};
static const int alphas[6] = {255, 192, 128, 64, 1, 0};

/* The picture's pixels as files have them: from the upper left one, row by row. */
static void read_pixel(const struct texture *texture, int pixel, float rgba[4])
{
    uint32_t row = (uint32_t)pixel / texture->width;
    texture_texel(texture, (uint32_t)pixel % texture->width, texture->height - 1 - row, rgba);
}

enum { NO_ALPHA, ALPHA };

static void assert_picture(const char *name, int codes[6][3], int with_alpha, double largest)
{
    for (int encoding = ENCODING_AUTO; encoding <= ENCODING_LINEAR; encoding++) {
        struct texture texture = load_data(name, encoding);
        assert_int_equal(texture.width, 3);
        assert_int_equal(texture.height, 2);
        for (int i = 0; i < 6; i++) {
            float rgba[4], expected[3];
            for (int k = 0; k < 3; k++) {
                double code = codes[i][k] / largest;
                expected[k] = encoding == ENCODING_LINEAR ? (float)code : decoded(code);
            }
            read_pixel(&texture, i, rgba);
            assert_color(rgba, expected[0], expected[1], expected[2],
                         with_alpha ? (float)alphas[i] / 255.0f : 1.0f, 1e-7f);
        }
        texture_release(&texture);
    }
}

static void assert_grey_picture(const char *name, const int codes[6], int with_alpha,
                                double largest)
{
    int spread[6][3];
    for (int i = 0; i < 6; i++) {
        spread[i][0] = spread[i][1] = spread[i][2] = codes[i];
    }
    assert_picture(name, spread, with_alpha, largest);
}

static void test_png_colors(void **state)
{
    (void)state;
    assert_picture("rgb8.png", colors, NO_ALPHA, 255);
    assert_picture("rgba8.png", colors, ALPHA, 255);
    assert_picture("palette.png", colors, NO_ALPHA, 255);
    assert_picture("palettealpha.png", colors, ALPHA, 255);
    assert_picture("interlaced.png", colors, NO_ALPHA, 255);
    assert_picture("gamma.png", colors, NO_ALPHA, 255);
}

static void test_png_greys(void **state)
{
    static const int one_bit[6] = {0, 1, 1, 1, 0, 0};
    static const int two_bits[6] = {0, 1, 2, 3, 0, 1};
    static const int four_bits[6] = {0, 5, 10, 15, 1, 2};
    (void)state;
    assert_grey_picture("grey8.png", greys, NO_ALPHA, 255);
    assert_grey_picture("greyalpha8.png", greys, ALPHA, 255);
    assert_grey_picture("grey1.png", one_bit, NO_ALPHA, 1);
    assert_grey_picture("grey2.png", two_bits, NO_ALPHA, 3);
    assert_grey_picture("grey4.png", four_bits, NO_ALPHA, 15);
}

static void test_png_16_bits(void **state)
{
    int deep_greys[6], deep_colors[6][3];
    (void)state;
    for (int i = 0; i < 6; i++) {
        deep_greys[i] = greys[i] == 50 ? 50 * 257 + 1 : greys[i] * 257;
        for (int k = 0; k < 3; k++) {
            deep_colors[i][k] = colors[i][k] == 64 ? 0x1234 : colors[i][k] * 257;
        }
    }
    assert_grey_picture("grey16.png", deep_greys, NO_ALPHA, 65535);
    assert_picture("rgb16.png", deep_colors, NO_ALPHA, 65535);
}

static void test_png_transparent_color(void **state)
{
    (void)state;
    struct texture texture = load_data("keyed.png", ENCODING_AUTO);
    for (int i = 0; i < 6; i++) {
        float rgba[4];
        read_pixel(&texture, i, rgba);
        assert_float_equal(rgba[3], i == 1 ? 0.0 : 1.0, 0.0);
    }
    texture_release(&texture);
}

/* Codes of JPEG's plain quarters are exact but for a step or two. */
static void assert_quarters(const char *name, const int codes[4][3])
{
    struct texture texture = load_data(name, ENCODING_LINEAR);
    assert_int_equal(texture.width, 32);
    assert_int_equal(texture.height, 32);
    for (int i = 0; i < 4; i++) {
        float rgba[4];
        texture_sample(&texture, i % 2 ? 0.75f : 0.25f, i / 2 ? 0.25f : 0.75f, rgba);
        assert_color(rgba, (float)codes[i][0] / 255.0f, (float)codes[i][1] / 255.0f,
                     (float)codes[i][2] / 255.0f, 1.0f, 2.01f / 255.0f);
    }
    texture_release(&texture);
}

static void test_jpeg(void **state)
{
    static const int quarters[4][3] = {
        {200, 40, 90}, {20, 160, 220}, {120, 120, 120}, {250, 250, 250}};
    static const int grey_quarters[4][3] = {
        {78, 78, 78}, {135, 135, 135}, {120, 120, 120}, {250, 250, 250}};
    float rgba[4];
    (void)state;
    assert_quarters("baseline.jpg", quarters);
    assert_quarters("progressive.jpg", quarters);
    assert_quarters("subsampled.jpg", quarters);
    assert_quarters("grey.jpg", grey_quarters);
    struct texture texture = load_data("grey.jpg", ENCODING_AUTO);
    texture_sample(&texture, 0.25f, 0.25f, rgba);
    assert_color(rgba, decoded(120 / 255.0), decoded(120 / 255.0), decoded(120 / 255.0), 1.0f,
                 0.01f);
    texture_release(&texture);
}

static void test_exr_halves(void **state)
{
    float rgba[4];
    (void)state;
    struct texture texture = load_data("half.exr", ENCODING_AUTO);
    assert_int_equal(texture.raster.sample, RASTER_HALF);
    for (int i = 0; i < 6; i++) {
        read_pixel(&texture, i, rgba);
        assert_color(rgba, (float)colors[i][0] / 255.0f, (float)colors[i][1] / 255.0f,
                     (float)colors[i][2] / 255.0f, 1.0f, 2e-4f);
    }
    texture_release(&texture);
    texture = load_data("half.exr", ENCODING_SRGB);
    read_pixel(&texture, 4, rgba);
    assert_color(rgba, decoded(128 / 255.0), decoded(64 / 255.0), decoded(32 / 255.0), 1.0f, 3e-4f);
    texture_release(&texture);
}

/* Writes a 2 x 1 picture whose channels hold the numbers. */
static const char *write_exr(void **state, const char *const *names, const float (*samples)[2])
{
    struct image image = {.width = 2, .height = 1};
    struct error error;
    const char *path = scratch_path(state, "written.exr");
    for (size_t i = 0; names[i]; i++) {
        float *plane = image_add_channel(&image, names[i]);
        assert_non_null(plane);
        memcpy(plane, samples[i], sizeof samples[i]);
    }
    assert_int_equal(image_write_exr(&image, path, IMAGE_ZIP, NULL, &error), PS_OK);
    image_release(&image);
    return path;
}

static struct texture load_path(const char *path, enum texture_encoding encoding)
{
    struct texture_description description = {.path = (char *)path, .encoding = encoding};
    struct texture texture;
    struct error error;
    if (texture_load(&description, NULL, &texture, &error) != PS_OK) {
        fail_msg("%s", error.text);
    }
    return texture;
}

static void test_exr_floats(void **state)
{
    static const char *const names[] = {"A", "B", "G", "R", "Z", "diffuse.R", NULL};
    static const float samples[][2] = {{0.3f, 1}, {1e6f, -3}, {0.1f, 4}, {7, 0}, {9, 9}, {8, 8}};
    float rgba[4];
    const char *path = write_exr(state, names, samples);
    struct texture texture = load_path(path, ENCODING_AUTO);
    assert_int_equal(texture.raster.sample, RASTER_FLOAT);
    texture_texel(&texture, 0, 0, rgba);
    assert_color(rgba, 7, 0.1f, 1e6f, 0.3f, 0);
    texture_texel(&texture, 1, 0, rgba);
    assert_color(rgba, 0, 4, -3, 1, 0);
    texture_release(&texture);
    texture = load_path(path, ENCODING_SRGB);
    texture_texel(&texture, 0, 0, rgba);
    assert_float_equal(rgba[1], decoded(0.1), 1e-7);
    assert_float_equal(rgba[3], 0.3f, 0);
    texture_release(&texture);
}

/* Of a picture with many layers no more is kept in memory than was asked for. */
static void test_exr_wanted_channels(void **state)
{
    static const char *const names[] = {"A", "B", "Z", "a.Y", "a.other", NULL};
    static const float samples[][2] = {{1, 2}, {3, 4}, {5, 6}, {7, 8}, {9, 10}};
    struct image image = {0};
    struct error error;
    size_t size;
    unsigned char *bytes = scratch_load(write_exr(state, names, samples), &size);
    struct raster_source source = {"some.exr", bytes, size, "a", NULL};
    struct exr_facts facts;
    assert_int_equal(exr_read_layer(&source, NULL, &image, &facts, &error), PS_OK);
    assert_int_equal(image.channel_count, 1);
    assert_memory_equal(image_channel(&image, "a.Y"), samples[3], sizeof samples[3]);
    image_release(&image);
    source.layer = NULL;
    assert_int_equal(exr_read_layer(&source, NULL, &image, &facts, &error), PS_OK);
    assert_int_equal(image.channel_count, 2);
    image_release(&image);
    free(bytes);
}

/* The first texel of a layer. */
static void expect_layer(const char *path, const char *layer, float r, float g, float b, float a)
{
    char of[64];
    float rgba[4];
    snprintf(of, sizeof of, "%s", layer);
    struct texture_description description = {.path = (char *)path, .layer = of};
    struct texture texture = {0};
    struct error error;
    if (texture_load(&description, NULL, &texture, &error) != PS_OK)
        fail_msg("%s", error.text);
    texture_texel(&texture, 0, 0, rgba);
    if (rgba[0] != r || rgba[1] != g || rgba[2] != b || rgba[3] != a)
        fail_msg("%s: %g %g %g %g", layer, (double)rgba[0], (double)rgba[1], (double)rgba[2],
                 (double)rgba[3]);
    texture_release(&texture);
}

static void expect_no_layer(const char *path, const char *layer, const char *words)
{
    char of[64];
    snprintf(of, sizeof of, "%s", layer);
    struct texture_description description = {.path = (char *)path, .layer = of};
    struct texture texture = {0};
    struct error error;
    assert_int_equal(texture_load(&description, NULL, &texture, &error), PS_ERROR_INVALID);
    if (!strstr(error.text, words))
        fail_msg("\"%s\" is not in \"%s\"", words, error.text);
}

static void test_exr_layers(void **state)
{
    static const char *const names[] = {"A",
                                        "Z",
                                        "albedo.B",
                                        "albedo.G",
                                        "albedo.R",
                                        "mask.A",
                                        "mask.Y",
                                        "n.X",
                                        "n.Y",
                                        "n.Z",
                                        "view.diffuse.A",
                                        "view.diffuse.B",
                                        "view.diffuse.G",
                                        "view.diffuse.R",
                                        NULL};
    static const float samples[][2] = {{1, 1},   {2, 2},   {3, 3},   {4, 4},  {5, 5},
                                       {6, 6},   {7, 7},   {8, 8},   {9, 9},  {10, 10},
                                       {11, 11}, {12, 12}, {13, 13}, {14, 14}};
    const char *path = write_exr(state, names, samples);
    expect_layer(path, "albedo", 5, 4, 3, 1);
    expect_layer(path, "Z", 2, 2, 2, 1);
    expect_layer(path, "mask", 7, 7, 7, 6);
    expect_layer(path, "n", 8, 9, 10, 1);
    expect_layer(path, "view.diffuse", 14, 13, 12, 11);
    expect_no_layer(path, "albed", "no layer 'albed'; it has A, Z, albedo, mask, n, view.diffuse");
    expect_no_layer(path, "view", "no layer 'view'");
    expect_no_layer(path, "", "no layer ''");
    expect_no_layer(data_path("keyed.png"), "x", "it is PNG, which has no layers");
    /* Of several parts, by the parts' names; the first part has positions alone. */
    expect_no_layer(data_path("parts.exr"), "x", "no layer 'x'; it has positions,");
}

/* Within the range of half floats, but between two of them. */
static void test_exr_precision(void **state)
{
    static const char *const names[] = {"Y", NULL};
    static const float samples[][2] = {{0.1f, 0.5f}};
    static const float small[][2] = {{0x1.8p-24f, 0.5f}};
    float rgba[4];
    struct texture texture = load_path(write_exr(state, names, samples), ENCODING_AUTO);
    texture_texel(&texture, 0, 0, rgba);
    assert_true(rgba[0] == 0.1f);
    texture_release(&texture);
    texture = load_path(write_exr(state, names, small), ENCODING_AUTO);
    texture_texel(&texture, 0, 0, rgba);
    assert_true(rgba[0] == 0x1.8p-24f);
    texture_release(&texture);
}

static void test_exr_brightness(void **state)
{
    static const char *const names[] = {"A", "Y", NULL};
    static const float samples[][2] = {{0.5f, 1}, {0x1p-24f, 65504}};
    float rgba[4];
    struct texture texture = load_path(write_exr(state, names, samples), ENCODING_AUTO);
    assert_int_equal(texture.raster.sample, RASTER_HALF);
    texture_texel(&texture, 0, 0, rgba);
    assert_color(rgba, 0x1p-24f, 0x1p-24f, 0x1p-24f, 0.5f, 0);
    texture_texel(&texture, 1, 0, rgba);
    assert_color(rgba, 65504, 65504, 65504, 1, 0);
    texture_release(&texture);
}

static void test_exr_without_numbers(void **state)
{
    static const char *const names[] = {"B", "G", "R", NULL};
    static const float samples[][2] = {{NAN, 1}, {INFINITY, 2}, {-INFINITY, 3}};
    float rgba[4];
    struct texture texture = load_path(write_exr(state, names, samples), ENCODING_AUTO);
    texture_texel(&texture, 0, 0, rgba);
    assert_color(rgba, -65504, 65504, 0, 1, 0);
    texture_release(&texture);
}

static void assert_is_half_exr(const struct texture *texture)
{
    assert_int_equal(texture->width, 3);
    assert_int_equal(texture->height, 2);
    for (int i = 0; i < 6; i++) {
        float rgba[4];
        read_pixel(texture, i, rgba);
        assert_color(rgba, (float)colors[i][0] / 255.0f, (float)colors[i][1] / 255.0f,
                     (float)colors[i][2] / 255.0f, 1.0f, 2e-4f);
    }
}

/* The largest of several levels (exrmaketiled -m); of two parts the one with colours (exrmultipart
 * -combine). */
static void test_exr_levels_and_parts(void **state)
{
    (void)state;
    struct texture texture = load_data("levels.exr", ENCODING_AUTO);
    assert_is_half_exr(&texture);
    texture_release(&texture);
    texture = load_data("parts.exr", ENCODING_AUTO);
    assert_is_half_exr(&texture);
    texture_release(&texture);
}

/* Of ACES 2065-1 (exrstdattr -chromaticities). Its matrix to Rec.709, by Bradford's adaptation, as
 * published. */
static void test_exr_chromaticities(void **state)
{
    static const double matrix[3][3] = {{2.52168619, -1.13413099, -0.38755521},
                                        {-0.27647991, 1.37271909, -0.09623918},
                                        {-0.01537806, -0.15297534, 1.16835340}};
    (void)state;
    struct texture texture = load_data("aces.exr", ENCODING_AUTO);
    for (int i = 0; i < 6; i++) {
        float rgba[4], expected[3];
        for (int k = 0; k < 3; k++)
            expected[k] = (float)((matrix[k][0] * colors[i][0] + matrix[k][1] * colors[i][1] +
                                   matrix[k][2] * colors[i][2]) /
                                  255);
        read_pixel(&texture, i, rgba);
        assert_color(rgba, expected[0], expected[1], expected[2], 1.0f, 1e-3f);
    }
    texture_release(&texture);
}

static unsigned char *find_window(unsigned char *bytes, size_t size, const char *name)
{
    size_t length = strlen(name) + 1;
    for (size_t i = 0; i + length + 26 <= size; i++)
        if (memcmp(bytes + i, name, length) == 0)
            return bytes + i + length + 6 + 4;
    fail_msg("no %s", name);
    return NULL;
}

/* The display window is the picture: here without the first column and line of the data, and beyond
 * them. */
static void test_exr_display_window(void **state)
{
    static const int32_t window[] = {1, 1, 4, 2}, large[] = {0, 0, 60000, 10000};
    struct texture texture;
    struct error error;
    size_t size;
    float rgba[4];
    (void)state;
    unsigned char *bytes = scratch_load(data_path("half.exr"), &size);
    memcpy(find_window(bytes, size, "displayWindow"), window, sizeof window);
    assert_int_equal(load_bytes(bytes, size, &texture, &error), PS_OK);
    assert_int_equal(texture.width, 4);
    assert_int_equal(texture.height, 2);
    read_pixel(&texture, 0, rgba);
    assert_color(rgba, 128 / 255.0f, 64 / 255.0f, 32 / 255.0f, 1, 2e-4f);
    read_pixel(&texture, 2, rgba);
    assert_color(rgba, 0, 0, 0, 1, 0);
    read_pixel(&texture, 5, rgba);
    assert_color(rgba, 0, 0, 0, 1, 0);
    texture_release(&texture);
    memcpy(find_window(bytes, size, "displayWindow"), large, sizeof large);
    assert_int_equal(load_bytes(bytes, size, &texture, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "display window"));
    free(bytes);
}

/* --- refused --------------------------------------------------------------------------------- */

static void assert_file_refused(const char *path, ps_result code, const char *reason)
{
    struct texture_description description = {.path = (char *)path};
    struct texture texture = {.width = 77};
    struct error error = {{0}};
    assert_int_equal(texture_load(&description, NULL, &texture, &error), code);
    assert_int_equal(texture.width, 77);
    if (strncmp(error.text, path, strlen(path)) != 0 || !strstr(error.text, reason)) {
        fail_msg("'%s' does not start with '%s' or say '%s'", error.text, path, reason);
    }
}

static void test_no_pictures(void **state)
{
    const char *path = scratch_path(state, "file");
    assert_file_refused(path, PS_ERROR_IO, "No such file");
    scratch_store(path, "", 0);
    assert_file_refused(path, PS_ERROR_INVALID, "empty");
    scratch_store(path, "GIF89a is not supported", 23);
    assert_file_refused(path, PS_ERROR_INVALID, "PNG, JPEG, OpenEXR");
    scratch_store(path, "\x89PN", 3);
    assert_file_refused(path, PS_ERROR_INVALID, "PNG, JPEG, OpenEXR");
    assert_file_refused(((struct scratch *)*state)->directory, PS_ERROR_IO, "directory");
    path = scratch_path(state, "pipe");
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_file_refused(path, PS_ERROR_IO, "regular");
}

static void test_content_decides(void **state)
{
    size_t size;
    unsigned char *bytes = scratch_load(data_path("rgb8.png"), &size);
    const char *path = scratch_path(state, "picture.jpg");
    scratch_store(path, bytes, size);
    struct texture texture = load_path(path, ENCODING_AUTO);
    assert_int_equal(texture.width, 3);
    texture_release(&texture);
    free(bytes);
}

/* A file of 62 bytes of this kind asked for gigabytes. */
static void test_arithmetic_coding(void **state)
{
    size_t size;
    unsigned char *bytes = scratch_load(data_path("baseline.jpg"), &size);
    size_t frame = 0;
    while (frame + 1 < size && !(bytes[frame] == 0xff && bytes[frame + 1] == 0xc0))
        frame++;
    assert_true(frame + 1 < size);
    bytes[frame + 1] = 0xc9;
    const char *path = scratch_path(state, "picture.jpg");
    scratch_store(path, bytes, size);
    assert_file_refused(path, PS_ERROR_INVALID, "its coding is arithmetic");
    free(bytes);
}

static void test_refused_kinds(void **state)
{
    static const char *const names[] = {"R", "G", "X", NULL};
    static const float samples[][2] = {{1, 1}, {1, 1}, {1, 1}};
    assert_file_refused(data_path("cmyk.jpg"), PS_ERROR_INVALID, "CMYK");
    assert_file_refused(write_exr(state, names, samples), PS_ERROR_INVALID, "no colours");
}

static const char *const pictures[] = {"rgb8.png",     "palette.png", "interlaced.png",
                                       "baseline.jpg", "grey.jpg",    "progressive.jpg",
                                       "half.exr",     "parts.exr"};
#define PICTURE_COUNT (sizeof pictures / sizeof *pictures)

static void test_every_truncation(void **state)
{
    (void)state;
    for (size_t i = 0; i < PICTURE_COUNT; i++) {
        size_t size;
        unsigned char *bytes = scratch_load(data_path(pictures[i]), &size);
        for (size_t length = 0; length < size; length++) {
            /* A copy of just that length, so that reading past it is seen by sanitizers. */
            unsigned char *part = malloc(length + 1);
            struct texture texture;
            struct error error;
            assert_non_null(part);
            memcpy(part, bytes, length);
            if (load_bytes(part, length, &texture, &error) == PS_OK) {
                fail_msg("%s: read %zu bytes of %zu", pictures[i], length, size);
            }
            free(part);
        }
        free(bytes);
    }
}

/* An error or a picture, whichever byte is damaged. */
static void test_every_changed_byte(void **state)
{
    (void)state;
    for (size_t i = 0; i < PICTURE_COUNT; i++) {
        size_t size, refused = 0;
        unsigned char *bytes = scratch_load(data_path(pictures[i]), &size);
        for (size_t k = 0; k < size; k++) {
            struct texture texture;
            struct error error;
            bytes[k] ^= 0x55;
            refused += load_bytes(bytes, size, &texture, &error) != PS_OK;
            texture_release(&texture);
            bytes[k] ^= 0x55;
        }
        assert_true(refused > 0);
        free(bytes);
    }
}

static void assert_bytes_refused(const unsigned char *bytes, size_t size, ps_result code,
                                 const char *reason)
{
    struct texture texture;
    struct error error;
    assert_int_equal(load_bytes(bytes, size, &texture, &error), code);
    if (!strstr(error.text, reason)) {
        fail_msg("'%s' does not say '%s'", error.text, reason);
    }
}

static void put_big_endian(unsigned char *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        bytes[i] = (unsigned char)(value >> (24 - 8 * i));
    }
}

/* CRC-32 of PNG, bit by bit. */
static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
        }
    }
    return ~crc;
}

static void assert_png_size_refused(uint32_t width, uint32_t height, ps_result code,
                                    const char *reason)
{
    size_t size;
    unsigned char *bytes = scratch_load(data_path("rgb8.png"), &size);
    put_big_endian(bytes + 16, width);
    put_big_endian(bytes + 20, height);
    put_big_endian(bytes + 29, checksum(bytes + 12, 17));
    assert_bytes_refused(bytes, size, code, reason);
    free(bytes);
}

static void test_png_sizes(void **state)
{
    (void)state;
    assert_png_size_refused(0, 2, PS_ERROR_IO, "damaged");
    assert_png_size_refused(65537, 2, PS_ERROR_INVALID, "65537 x 2 pixels");
    assert_png_size_refused(65536, 16385, PS_ERROR_INVALID, "3 GiB of memory");
    assert_png_size_refused(0x7fffffff, 0x7fffffff, PS_ERROR_INVALID, "limit");
    assert_png_size_refused(32768, 32768, PS_ERROR_IO, "too early");
    assert_png_size_refused(3, 3, PS_ERROR_IO, "damaged");
}

/* The frame header (SOF0 or SOF2) holds the height and width as 16 bits each. */
static void assert_jpeg_size_refused(const char *name, uint32_t width, uint32_t height,
                                     ps_result code, const char *reason)
{
    size_t size, at = 2;
    unsigned char *bytes = scratch_load(data_path(name), &size);
    while (bytes[at + 1] != 0xc0 && bytes[at + 1] != 0xc2) {
        at += 2 + 256u * bytes[at + 2] + bytes[at + 3];
        assert_true(at < size);
    }
    bytes[at + 5] = (unsigned char)(height >> 8);
    bytes[at + 6] = (unsigned char)height;
    bytes[at + 7] = (unsigned char)(width >> 8);
    bytes[at + 8] = (unsigned char)width;
    assert_bytes_refused(bytes, size, code, reason);
    free(bytes);
}

static void test_jpeg_sizes(void **state)
{
    (void)state;
    assert_jpeg_size_refused("baseline.jpg", 0, 32, PS_ERROR_IO, "damaged");
    assert_jpeg_size_refused("baseline.jpg", 32, 0, PS_ERROR_IO, "damaged");
    assert_jpeg_size_refused("baseline.jpg", 65500, 65500, PS_ERROR_INVALID, "limit");
    assert_jpeg_size_refused("baseline.jpg", 30000, 30000, PS_ERROR_IO, "too early");
    assert_jpeg_size_refused("progressive.jpg", 30000, 30000, PS_ERROR_IO, "too early");
    assert_jpeg_size_refused("baseline.jpg", 64, 64, PS_ERROR_IO, "damaged");
}

static void test_exr_sizes(void **state)
{
    static const int32_t large[] = {70000, 1 << 20, INT32_MAX / 8};
    size_t size;
    unsigned char *bytes = scratch_load(data_path("half.exr"), &size);
    unsigned char *window = bytes;
    (void)state;
    while (memcmp(window, "dataWindow\0box2i\0", 17) != 0) {
        window++;
    }
    for (size_t i = 0; i < sizeof large / sizeof *large; i++) {
        int32_t last = large[i] - 1;
        memcpy(window + 17 + 4 + 8, &last, 4);
        assert_bytes_refused(bytes, size, PS_ERROR_INVALID, "limit");
    }
    int32_t corner[] = {32767, 32767};
    memcpy(window + 17 + 4 + 8, corner, sizeof corner);
    assert_bytes_refused(bytes, size, PS_ERROR_IO, "too early");
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png_colors),
        cmocka_unit_test(test_png_greys),
        cmocka_unit_test(test_png_16_bits),
        cmocka_unit_test(test_png_transparent_color),
        cmocka_unit_test(test_jpeg),
        cmocka_unit_test(test_exr_halves),
        SCRATCH_TEST(test_exr_floats),
        SCRATCH_TEST(test_exr_wanted_channels),
        SCRATCH_TEST(test_exr_layers),
        SCRATCH_TEST(test_exr_precision),
        SCRATCH_TEST(test_exr_brightness),
        SCRATCH_TEST(test_exr_without_numbers),
        cmocka_unit_test(test_exr_levels_and_parts),
        cmocka_unit_test(test_exr_chromaticities),
        cmocka_unit_test(test_exr_display_window),
        SCRATCH_TEST(test_no_pictures),
        SCRATCH_TEST(test_content_decides),
        SCRATCH_TEST(test_arithmetic_coding),
        SCRATCH_TEST(test_refused_kinds),
        cmocka_unit_test(test_every_truncation),
        cmocka_unit_test(test_every_changed_byte),
        cmocka_unit_test(test_png_sizes),
        cmocka_unit_test(test_jpeg_sizes),
        cmocka_unit_test(test_exr_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
