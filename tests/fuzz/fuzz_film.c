/* fuzz_film.c: feeds arbitrary bytes to the reader of films, and through it to that of OpenEXR
 * files (libFuzzer).
 *
 * Beyond crashes and leaks it checks the reader's promises: a failure says why and leaves nothing;
 * a film has passes and the planes that a picture is made of, adds up with none, and is read back
 * as it is written.
 */
#include "job/film_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

/* Reading is by path, since the library maps what it needs of large films. */
static void write_file(char path[], const uint8_t *data, size_t size)
{
    int descriptor = mkstemp(path);
    require(descriptor >= 0);
    require(write(descriptor, data, size) == (ssize_t)size);
    close(descriptor);
}

static void check_round_trip(const char *path, const struct film_sum *sum,
                             const struct image *facts)
{
    struct film_sum again;
    struct image facts_again;
    struct error error = {{0}};
    if (film_file_write(path, sum, facts, IMAGE_UNCOMPRESSED, NULL, &error) != PS_OK) {
        require(strstr(error.text, "no numbers") != NULL);
        return;
    }
    require(film_file_read(path, &again, &facts_again, &error) == PS_OK);
    require(film_sum_is_alike(sum, &again));
    require(pass_set_size(&sum->passes) == pass_set_size(&again.passes));
    film_sum_release(&again);
    image_release(&facts_again);
}

static void check_film(const char *path, const struct film_sum *sum, const struct image *facts)
{
    struct film film;
    struct error error = {{0}};
    require(sum->passes.count > 0 && sum->width > 0 && sum->height > 0);
    require(film_sum_create_film(sum, &film, &error) == PS_OK);
    film_sum_round(sum, &film, NULL);
    film_release(&film);
    check_round_trip(path, sum, facts);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[] = "/tmp/fuzz_film_XXXXXX";
    struct film_sum sum;
    struct image facts;
    struct error error = {{0}};
    write_file(path, data, size);
    if (film_file_read(path, &sum, &facts, &error) == PS_OK) {
        check_film(path, &sum, &facts);
        film_sum_release(&sum);
        image_release(&facts);
    } else {
        require(strncmp(error.text, "cannot read '", 13) == 0 || error.text[0] == '\'');
        require(!sum.object && !sum.planes[0].high && !facts.channels && !facts.attributes);
    }
    unlink(path);
    return 0;
}
