#include "cli/viewer.h"

#include "cli/command.h"
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct viewer {
    struct tev_address address;
    char name[256];
    bool has_display;
    pthread_t thread;
    pthread_mutex_t mutex;
    pthread_cond_t changed;
    /* Guarded by the mutex. */
    psplat_picture *next; /* to be sent, owned; NULL: none */
    bool busy, ends;      /* with one of them; after it */
    struct error reason;  /* why the last one was not sent; no text: it was */
    bool has_failed;      /* and that was said */
};

bool viewer_parse(const char *value, struct tev_address *address)
{
    bool good = strncmp(value, "tev", 3) == 0 && tev_parse_address(value + 3, address);
    if (!good)
        fprintf(stderr,
                "psplat: error: --display: expected tev, tev:HOST or tev:HOST:PORT, got '%s'\n",
                value);
    return good;
}

/* --- the thread
 * ----------------------------------------------------------------------------------- */

/* The error has a text where that fails. */
static void send_picture(const struct viewer *viewer, const psplat_picture *picture,
                         int *connection, struct error *error)
{
    bool is_new = *connection < 0;
    ps_result result = is_new ? tev_connect(&viewer->address, connection, error) : PS_OK;
    if (result == PS_OK)
        result = tev_send(*connection, viewer->name, picture, viewer->has_display, is_new, error);
    if (result != PS_OK && *connection >= 0) {
        close(*connection);
        *connection = -1;
    }
}

/* Waits for a picture, which becomes the caller's; NULL at the end. */
static psplat_picture *take_next(struct viewer *viewer)
{
    pthread_mutex_lock(&viewer->mutex);
    while (!viewer->next && !viewer->ends)
        pthread_cond_wait(&viewer->changed, &viewer->mutex);
    psplat_picture *picture = viewer->next;
    viewer->next = NULL;
    viewer->busy = picture != NULL;
    pthread_mutex_unlock(&viewer->mutex);
    return picture;
}

static void *send_pictures(void *user)
{
    struct viewer *viewer = user;
    psplat_picture *picture;
    int connection = -1;
    while ((picture = take_next(viewer))) {
        struct error error = {.text = ""};
        send_picture(viewer, picture, &connection, &error);
        psplat_picture_destroy(picture);
        pthread_mutex_lock(&viewer->mutex);
        viewer->busy = false;
        viewer->reason = error;
        pthread_cond_broadcast(&viewer->changed);
        pthread_mutex_unlock(&viewer->mutex);
    }
    if (connection >= 0)
        close(connection);
    return NULL;
}

/* --- the caller's thread
 * -------------------------------------------------------------------------- */

struct viewer *viewer_create(const struct tev_address *address, const char *name, bool has_display)
{
    struct viewer *viewer = calloc(1, sizeof *viewer);
    size_t length = strlen(name), most = sizeof viewer->name - 1;
    if (viewer) {
        viewer->address = *address;
        viewer->has_display = has_display;
        snprintf(viewer->name, sizeof viewer->name, "%s",
                 name + (length > most ? length - most : 0));
        pthread_mutex_init(&viewer->mutex, NULL);
        pthread_cond_init(&viewer->changed, NULL);
        if (pthread_create(&viewer->thread, NULL, send_pictures, viewer) == 0)
            return viewer;
        pthread_cond_destroy(&viewer->changed);
        pthread_mutex_destroy(&viewer->mutex);
        free(viewer);
    }
    print_error("--display: there is no memory for it");
    return NULL;
}

/* With the mutex. */
static void tell_of_failure(struct viewer *viewer)
{
    if (viewer->reason.text[0] && !viewer->has_failed)
        print_warning(viewer->reason.text);
    viewer->has_failed = viewer->reason.text[0] != '\0';
}

static void wait_until_idle(struct viewer *viewer)
{
    while (viewer->busy || viewer->next)
        pthread_cond_wait(&viewer->changed, &viewer->mutex);
}

void viewer_show(struct viewer *viewer, psplat_picture *picture, bool is_last)
{
    pthread_mutex_lock(&viewer->mutex);
    if (is_last)
        wait_until_idle(viewer);
    bool takes = !viewer->busy && !viewer->next;
    if (takes) {
        tell_of_failure(viewer);
        viewer->next = picture;
        pthread_cond_broadcast(&viewer->changed);
    }
    pthread_mutex_unlock(&viewer->mutex);
    if (!takes)
        psplat_picture_destroy(picture);
}

void viewer_destroy(struct viewer *viewer)
{
    if (!viewer)
        return;
    pthread_mutex_lock(&viewer->mutex);
    wait_until_idle(viewer);
    tell_of_failure(viewer);
    viewer->ends = true;
    pthread_cond_broadcast(&viewer->changed);
    pthread_mutex_unlock(&viewer->mutex);
    pthread_join(viewer->thread, NULL);
    pthread_cond_destroy(&viewer->changed);
    pthread_mutex_destroy(&viewer->mutex);
    free(viewer);
}
