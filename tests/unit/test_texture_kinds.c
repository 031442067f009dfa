/* test_texture_kinds.c: the kinds of pictures that only some builds read: TGA, BMP, Radiance HDR
 * and WebP, byte by byte; and those that none reads. */
#include "texture_fixture.h"

#define LINE_AT_TOP 0x20

/* Left to right, top line first: red, green, blue; black, (128, 64, 32), white. */
#define TARGA(kind, depth, flags) 0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, depth, flags
static const unsigned char targa_top[] = {TARGA(2, 24, LINE_AT_TOP),
                                          0,
                                          0,
                                          255,
                                          0,
                                          255,
                                          0,
                                          255,
                                          0,
                                          0,
                                          0,
                                          0,
                                          0,
                                          32,
                                          64,
                                          128,
                                          255,
                                          255,
                                          255};
static const unsigned char targa_bottom[] = {
    TARGA(2, 24, 0), 0, 0, 0, 32, 64, 128, 255, 255, 255, 0, 0, 255, 0, 255, 0, 255, 0, 0};
/* A plain packet of four pixels, one of a repeated colour. */
static const unsigned char targa_runs[] = {
    TARGA(10, 24, LINE_AT_TOP), 3, 0, 0, 255, 0, 255, 0, 255, 0, 0, 0, 0, 0, 0x81, 32, 64, 128};
static const unsigned char targa_grey[] = {TARGA(3, 8, LINE_AT_TOP), 0, 50, 100, 150, 200, 255};
/* A palette of two colours. */
static const unsigned char targa_palette[] = {0,   1,   1,   0,   0, 2, 0, 24,          0,  0,
                                              0,   0,   3,   0,   2, 0, 8, LINE_AT_TOP, 32, 64,
                                              128, 255, 255, 255, 0, 1, 0, 1,           0,  1};
static const unsigned char targa_alpha[] = {
    0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 32, LINE_AT_TOP | 8, 32, 64, 128, 51};

/* Lines from the bottom, each filled up to 12 bytes. */
static const unsigned char bitmap[] = {
    'B', 'M', 78,  0, 0, 0, 0, 0, 0,   0, 54,  0, 0,   0, 40, 0, 0, 0,  3,  0,
    0,   0,   2,   0, 0, 0, 1, 0, 24,  0, 0,   0, 0,   0, 24, 0, 0, 0,  0,  0,
    0,   0,   0,   0, 0, 0, 0, 0, 0,   0, 0,   0, 0,   0, 0,  0, 0, 32, 64, 128,
    255, 255, 255, 0, 0, 0, 0, 0, 255, 0, 255, 0, 255, 0, 0,  0, 0, 0};

/* Two pixels, (1, 0.5, 0.25) and (96, 0, 0); then a line of eight in runs. */
#define RADIANCE "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"
static const char radiance_plain[] = RADIANCE "-Y 1 +X 2\n\x80\x40\x20\x81\xc0\x00\x00\x87";
static const char radiance_runs[] = RADIANCE "-Y 1 +X 8\n\x02\x02\x00\x08"
                                             "\x88\x80"
                                             "\x88\x40"
                                             "\x08\x20\x20\x20\x20\x20\x20\x20\x20"
                                             "\x84\x81\x84\x82";

/* As targa_top, with alpha; and 32 x 32 of four plain quarters: from libwebp's own encoder. */
static const unsigned char webp_lossless[] = {
    0x52, 0x49, 0x46, 0x46, 0x40, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38,
    0x4c, 0x34, 0x00, 0x00, 0x00, 0x2f, 0x02, 0x40, 0x00, 0x10, 0x2f, 0x40, 0x90, 0x6d, 0xd3,
    0x99, 0xdd, 0x5f, 0xea, 0x1a, 0x04, 0x92, 0x36, 0xae, 0xf9, 0x9b, 0x5f, 0x20, 0x40, 0x70,
    0xe2, 0x7f, 0x92, 0x40, 0x80, 0xf0, 0x5f, 0x45, 0x99, 0x70, 0xbe, 0x91, 0x65, 0xd1, 0xad,
    0x40, 0x20, 0x40, 0x19, 0x2b, 0x8e, 0x18, 0x25, 0xa2, 0xff, 0xb1, 0x5e};
static const unsigned char webp_lossy[] = {
    0x52, 0x49, 0x46, 0x46, 0x66, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x20,
    0x5a, 0x00, 0x00, 0x00, 0xd0, 0x04, 0x00, 0x9d, 0x01, 0x2a, 0x20, 0x00, 0x20, 0x00, 0x3e, 0x15,
    0x08, 0x83, 0x41, 0x21, 0x06, 0xff, 0x55, 0x00, 0x04, 0x00, 0x51, 0x2d, 0x00, 0x17, 0x65, 0xed,
    0xbf, 0x66, 0xfc, 0x00, 0xfd, 0x00, 0xfe, 0xab, 0xbe, 0x03, 0xf4, 0x03, 0x3b, 0xec, 0x21, 0xc8,
    0xc7, 0xb4, 0xc0, 0x00, 0xfe, 0xf9, 0x66, 0xdc, 0xf2, 0x7f, 0xff, 0xcc, 0xb4, 0x04, 0x8c, 0x64,
    0x0f, 0x1d, 0x68, 0xe4, 0x54, 0x0f, 0x35, 0xa3, 0x5b, 0xf7, 0x49, 0x0d, 0x44, 0xc3, 0x2a, 0x37,
    0xfb, 0x34, 0x85, 0x2e, 0xd2, 0x78, 0x9a, 0xbf, 0xfe, 0x0c, 0x80, 0x00, 0x00, 0x00};

static const int colors[6][3] = {{255, 0, 0}, {0, 255, 0},   {0, 0, 255},
                                 {0, 0, 0},   {128, 64, 32}, {255, 255, 255}};

struct bytes {
    const void *data;
    size_t size;
};
#define BYTES(array) ((struct bytes){array, sizeof(array)})
#define TEXT(array) ((struct bytes){array, sizeof(array) - 1})

static void need(const char *kind)
{
    if (!strstr(raster_kinds, kind)) {
        printf("skipped: this build reads no %s\n", kind);
        skip();
    }
}

static struct texture load(struct bytes bytes, enum texture_encoding encoding)
{
    struct texture_description description = {.path = "some.picture",
                                              .bytes = (unsigned char *)bytes.data,
                                              .byte_count = bytes.size,
                                              .encoding = encoding};
    struct texture texture = {0};
    struct error error = {{0}};
    if (texture_load(&description, NULL, &texture, &error) != PS_OK)
        fail_msg("%s", error.text);
    return texture;
}

/* From the upper left pixel, row by row. */
static void assert_pixel(const struct texture *texture, int pixel, const int expected[3],
                         float alpha)
{
    float rgba[4];
    uint32_t row = (uint32_t)pixel / texture->width;
    texture_texel(texture, (uint32_t)pixel % texture->width, texture->height - 1 - row, rgba);
    assert_color(rgba, (float)expected[0] / 255.0f, (float)expected[1] / 255.0f,
                 (float)expected[2] / 255.0f, alpha, 1e-6f);
}

static void assert_colors(struct bytes bytes, const int expected[6][3])
{
    struct texture texture = load(bytes, ENCODING_LINEAR);
    assert_int_equal(texture.width, 3);
    assert_int_equal(texture.height, 2);
    for (int i = 0; i < 6; i++)
        assert_pixel(&texture, i, expected[i], 1.0f);
    texture_release(&texture);
}

static void targa(void **state)
{
    static const int runs[6][3] = {{255, 0, 0}, {0, 255, 0},   {0, 0, 255},
                                   {0, 0, 0},   {128, 64, 32}, {128, 64, 32}};
    static const int greys[6][3] = {{0, 0, 0},       {50, 50, 50},    {100, 100, 100},
                                    {150, 150, 150}, {200, 200, 200}, {255, 255, 255}};
    static const int two[6][3] = {{128, 64, 32},   {255, 255, 255}, {128, 64, 32},
                                  {255, 255, 255}, {128, 64, 32},   {255, 255, 255}};
    (void)state;
    need("TGA");
    assert_colors(BYTES(targa_top), colors);
    assert_colors(BYTES(targa_bottom), colors);
    assert_colors(BYTES(targa_runs), runs);
    assert_colors(BYTES(targa_grey), greys);
    assert_colors(BYTES(targa_palette), two);
    struct texture texture = load(BYTES(targa_alpha), ENCODING_LINEAR);
    assert_pixel(&texture, 0, colors[4], 0.2f);
    texture_release(&texture);
    unsigned char changed[sizeof targa_alpha];
    memcpy(changed, targa_alpha, sizeof changed);
    changed[17] = LINE_AT_TOP; /* the header says that there is none */
    texture = load(BYTES(changed), ENCODING_LINEAR);
    assert_pixel(&texture, 0, colors[4], 0.2f);
    texture_release(&texture);
    changed[21] = 0;
    texture = load(BYTES(changed), ENCODING_LINEAR);
    assert_pixel(&texture, 0, colors[4], 1);
    texture_release(&texture);
}

static void bmp(void **state)
{
    (void)state;
    need("BMP");
    assert_colors(BYTES(bitmap), colors);
    struct texture texture = load(BYTES(bitmap), ENCODING_AUTO);
    assert_true(texture.raster.srgb);
    texture_release(&texture);
}

static void radiance(void **state)
{
    float rgba[4];
    (void)state;
    need("Radiance");
    struct texture texture = load(TEXT(radiance_plain), ENCODING_AUTO);
    assert_int_equal(texture.width, 2);
    assert_int_equal(texture.raster.sample, RASTER_FLOAT);
    texture_texel(&texture, 0, 0, rgba);
    assert_color(rgba, 1, 0.5f, 0.25f, 1, 0);
    texture_texel(&texture, 1, 0, rgba);
    assert_color(rgba, 96, 0, 0, 1, 0);
    texture_release(&texture);
    texture = load(TEXT(radiance_runs), ENCODING_AUTO);
    assert_int_equal(texture.width, 8);
    texture_texel(&texture, 3, 0, rgba);
    assert_color(rgba, 1, 0.5f, 0.25f, 1, 0);
    texture_texel(&texture, 4, 0, rgba);
    assert_color(rgba, 2, 1, 0.5f, 1, 0);
    texture_release(&texture);
}

static void webp(void **state)
{
    static const float alphas[6] = {255, 192, 128, 64, 1, 255};
    static const int quarters[4][3] = {
        {200, 40, 90}, {20, 160, 220}, {120, 120, 120}, {250, 250, 250}};
    (void)state;
    need("WebP");
    struct texture texture = load(BYTES(webp_lossless), ENCODING_LINEAR);
    assert_int_equal(texture.width, 3);
    for (int i = 0; i < 6; i++)
        assert_pixel(&texture, i, colors[i], alphas[i] / 255.0f);
    texture_release(&texture);
    texture = load(BYTES(webp_lossy), ENCODING_LINEAR);
    assert_int_equal(texture.width, 32);
    for (int i = 0; i < 4; i++) {
        float rgba[4];
        texture_sample(&texture, i % 2 ? 0.75f : 0.25f, i / 2 ? 0.25f : 0.75f, rgba);
        assert_color(rgba, (float)quarters[i][0] / 255.0f, (float)quarters[i][1] / 255.0f,
                     (float)quarters[i][2] / 255.0f, 1.0f, 5.0f / 255.0f);
    }
    texture_release(&texture);
}

/* A copy of just that length, so that reading past it is seen by sanitizers. */
static ps_result load_part(struct bytes bytes, size_t length, struct error *error)
{
    struct texture texture;
    unsigned char *part = malloc(length + 1);
    assert_non_null(part);
    memcpy(part, bytes.data, length);
    ps_result result = load_bytes(part, length, &texture, error);
    texture_release(&texture);
    free(part);
    return result;
}

static void assert_truncations_refused(struct bytes bytes)
{
    for (size_t length = 0; length < bytes.size; length++) {
        struct error error;
        if (load_part(bytes, length, &error) == PS_OK)
            fail_msg("read %zu bytes of %zu", length, bytes.size);
    }
}

/* A picture of 2 by 3, whose pixels are 1 to 6, line by line from the top: in each of the eight
 * orders. */
static void radiance_lines_in_any_order(void **state)
{
    static const struct {
        const char *resolution;
        unsigned char order[6];
    } cases[] = {
        {"-Y 3 +X 2", {1, 2, 3, 4, 5, 6}}, {"-Y 3 -X 2", {2, 1, 4, 3, 6, 5}},
        {"+Y 3 +X 2", {5, 6, 3, 4, 1, 2}}, {"+Y 3 -X 2", {6, 5, 4, 3, 2, 1}},
        {"+X 2 -Y 3", {1, 3, 5, 2, 4, 6}}, {"+X 2 +Y 3", {5, 3, 1, 6, 4, 2}},
        {"-X 2 -Y 3", {2, 4, 6, 1, 3, 5}}, {"-X 2 +Y 3", {6, 4, 2, 5, 3, 1}},
    };
    (void)state;
    need("Radiance");
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char bytes[200];
        float rgba[4];
        int length = snprintf((char *)bytes, sizeof bytes, RADIANCE "%s\n", cases[i].resolution);
        for (int k = 0; k < 6; k++) {
            const unsigned char pixel[4] = {cases[i].order[k], 0, 0, 128 + 8};
            memcpy(bytes + length + 4 * k, pixel, 4);
        }
        struct bytes file = {bytes, (size_t)length + 24};
        struct texture texture = load(file, ENCODING_AUTO);
        assert_int_equal(texture.width, 2);
        assert_int_equal(texture.height, 3);
        for (int k = 0; k < 6; k++) {
            texture_texel(&texture, k % 2, 2 - k / 2, rgba); /* from the bottom */
            assert_color(rgba, (float)(k + 1), 0, 0, 1, 0);
        }
        texture_release(&texture);
        assert_truncations_refused(file);
    }
}

static void every_truncation_is_refused(void **state)
{
    (void)state;
    need("TGA");
    assert_truncations_refused(BYTES(targa_top));
    assert_truncations_refused(BYTES(targa_runs));
    assert_truncations_refused(BYTES(targa_grey));
    assert_truncations_refused(BYTES(targa_palette));
    assert_truncations_refused(BYTES(bitmap));
    assert_truncations_refused(TEXT(radiance_plain));
    assert_truncations_refused(TEXT(radiance_runs));
    need("WebP");
    assert_truncations_refused(BYTES(webp_lossless));
    assert_truncations_refused(BYTES(webp_lossy));
}

static void assert_refused(struct bytes bytes, ps_result code, const char *reason)
{
    struct error error;
    assert_int_equal(load_part(bytes, bytes.size, &error), code);
    if (!strstr(error.text, reason))
        fail_msg("'%s' does not say '%s'", error.text, reason);
}

/* A small file must not take gigabytes. */
static void large_claims_are_refused(void **state)
{
    unsigned char changed[sizeof targa_runs];
    (void)state;
    need("TGA");
    memcpy(changed, targa_runs, sizeof changed);
    changed[13] = changed[15] = 0x40; /* 16387 x 16386 */
    assert_refused(BYTES(changed), PS_ERROR_IO, "too early");
    changed[13] = changed[15] = 0xff;
    assert_refused(BYTES(changed), PS_ERROR_INVALID, "limit");
    assert_refused(TEXT(RADIANCE "-Y 30000 +X 30000\n"), PS_ERROR_IO, "too early");
}

/* 16384 x 16384 of lossless WebP, whose codes could all be empty. */
static void large_webp_is_refused(void **state)
{
    unsigned char changed[sizeof webp_lossless];
    (void)state;
    need("WebP");
    memcpy(changed, webp_lossless, sizeof changed);
    changed[21] = changed[22] = changed[23] = 0xff;
    changed[24] = 0x1f;
    assert_refused(BYTES(changed), PS_ERROR_IO, "too early");
}

static void unread_kinds_are_named(void **state)
{
    (void)state;
    assert_refused(TEXT("\xabKTX 20\xbb\r\n\x1a\n.........."), PS_ERROR_INVALID, "KTX2");
    assert_refused(TEXT("DDS |................"), PS_ERROR_INVALID, "DDS");
    assert_refused(TEXT("GIF89a................"), PS_ERROR_INVALID, "GIF");
    assert_refused(TEXT("plain text of no picture"), PS_ERROR_INVALID, "PNG, JPEG, OpenEXR");
}

static void unread_ways_of_coding_are_named(void **state)
{
    unsigned char changed[sizeof bitmap];
    (void)state;
    need("BMP");
    memcpy(changed, bitmap, sizeof changed);
    changed[30] = 1;
    assert_refused(BYTES(changed), PS_ERROR_INVALID, "BMP in runs");
    assert_false(raster_is_known(changed, RASTER_MAGIC)); /* importers leave it out */
    assert_string_equal(raster_unread_kind(changed, RASTER_MAGIC), "BMP in runs");
    assert_refused(TEXT("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 2\n12345678"),
                   PS_ERROR_INVALID, "XYZE");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(targa),
        cmocka_unit_test(bmp),
        cmocka_unit_test(radiance),
        cmocka_unit_test(radiance_lines_in_any_order),
        cmocka_unit_test(webp),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(large_claims_are_refused),
        cmocka_unit_test(large_webp_is_refused),
        cmocka_unit_test(unread_kinds_are_named),
        cmocka_unit_test(unread_ways_of_coding_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
