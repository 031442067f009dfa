/* gbuffer_fixture.h: a G-buffer for all tests of a file. */
#ifndef TESTS_GBUFFER_FIXTURE_H
#define TESTS_GBUFFER_FIXTURE_H

#include "film/gbuffer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static struct gbuffer gbuffer;

/* For a setup of cmocka: 0 where it is there. */
static int create_gbuffer(uint32_t width, uint32_t height)
{
    struct error error;
    return gbuffer_create(gbuffer_layout(width, height), &gbuffer, &error);
}

/* A teardown. */
static int close_gbuffer(void **state)
{
    (void)state;
    gbuffer_release(&gbuffer);
    return 0;
}

#endif
