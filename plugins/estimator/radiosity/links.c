#include "links.h"

#include "exchange.h"
#include "lighting.h"
#include <float.h>

enum { BATCH = 16 }; /* candidates of an item of a loop */

#define SMALLEST 1e-8f /* area of a triangle that is divided, in squares of the scene's radius */
#define DIMMEST 0.25f  /* of the mean brightness; darker elements are as exact as these */
#define IN_SHADOW 4.0f /* factor on the light of links that some shadow rays are blocked of */

/* Two elements that may exchange light. */
struct pair {
    uint32_t p, q;
};

/* Of a pair that is linked. */
struct pair_link {
    uint32_t p, q;
    float exchange; /* F_pq A_p */
    uint32_t is_clear;
};

enum verdict { DROP, LINK, DIVIDE };

struct judgement {
    enum verdict verdict;
    struct exchange exchange;
};

struct refinement {
    struct elements *elements;
    const struct links_setting *setting;
    float allowed;           /* flux of a link to an element of mean brightness, in units of area */
    float mean;              /* irradiance, W/m^2 */
    bool is_full;            /* no more links are allowed than those that there will be */
    struct array brightness; /* struct brightness, of each element */
    struct array pairs, children; /* struct pair: of this round, and of the next one */
    struct array linked;          /* struct pair_link */
    struct judgement *judgements; /* of the pairs */
};

/* --- how bright elements are --- */

/* What links of an element go by. */
struct brightness {
    float leaves; /* the largest radiosity of its parts, W/m^2, about */
    /* How much less than others it may be off by: 1 where it is as bright as the mean. */
    float needs;
};

static struct brightness *brightness(const struct refinement *work, size_t index)
{
    return (struct brightness *)work->brightness.items + index;
}

static struct brightness brightness_of(const struct refinement *work, size_t index)
{
    const struct element *element = elements_at(work->elements, index);
    if (element_is_cluster(element)) {
        const struct brightness *parts = brightness(work, element->child);
        return (struct brightness){ps_max(parts[0].leaves, parts[1].leaves),
                                   ps_max(parts[0].needs, parts[1].needs)};
    }
    ps_rgb indirect = ps_rgb_scale(element->albedo, element->ambient);
    float arrives = ps_rgb_maximum(element->direct) + element->ambient;
    return (struct brightness){
        ps_rgb_maximum(ps_rgb_add(element->reflected, indirect)),
        ps_max(DIMMEST, ps_min(1.0f, arrives / work->mean)),
    };
}

/* Of the elements from `first` on. */
static bool find_brightness(struct refinement *work, size_t first)
{
    size_t count = work->elements->tree.count;
    if (!array_reserve(work->elements->host, &work->brightness, count - work->brightness.count,
                       sizeof(struct brightness), "radiosity elements"))
        return false;
    work->brightness.count = count;
    for (size_t i = count; i-- > first;)
        *brightness(work, i) = brightness_of(work, i);
    return true;
}

static void measure_light(struct refinement *work)
{
    const struct element *scene = elements_at(work->elements, 0);
    work->mean = ps_max(ps_rgb_maximum(scene->direct) + scene->ambient, FLT_MIN);
    work->allowed = (float)work->setting->epsilon * ps_rgb_maximum(scene->reflected) * scene->area;
}

/* --- judging pairs --- */

/* The one of two that is divided: the larger; ELEMENT_NONE where neither can be. */
static uint32_t larger_of(const struct elements *elements, struct pair pair)
{
    const struct element *p = elements_at(elements, pair.p), *q = elements_at(elements, pair.q);
    bool p_can = element_is_cluster(p) || p->area > SMALLEST;
    bool q_can = element_is_cluster(q) || q->area > SMALLEST;
    if (!p_can && !q_can)
        return ELEMENT_NONE;
    return p_can && (!q_can || p->radius >= q->radius) ? pair.p : pair.q;
}

static struct judgement judge(const struct refinement *work, struct pair pair)
{
    const struct elements *elements = work->elements;
    struct judgement judgement = {.verdict = DROP};
    if (pair.p == pair.q) {
        judgement.verdict = element_is_cluster(elements_at(elements, pair.p)) ? DIVIDE : DROP;
        return judgement;
    }
    if (!exchange_is_possible(elements, pair.p, pair.q))
        return judgement;
    const struct brightness *p = brightness(work, pair.p), *q = brightness(work, pair.q);
    float light = ps_max(p->leaves / q->needs, q->leaves / p->needs);
    bool may_divide = !work->is_full && larger_of(elements, pair) != ELEMENT_NONE;
    /* Before any ray is traced: what is far too much is divided anyway. */
    struct exchange *exchange = &judgement.exchange;
    *exchange = exchange_without_shadows(elements, pair.p, pair.q);
    judgement.verdict = DIVIDE;
    if (may_divide && exchange->most * light > 32.0f * work->allowed)
        return judgement;
    exchange_add_shadows(elements, pair.p, pair.q, exchange);
    bool shadow = exchange->visible > 0.0f && exchange->visible < 1.0f;
    if (may_divide && exchange->most * light * (shadow ? IN_SHADOW : 1.0f) > work->allowed)
        return judgement;
    judgement.verdict = LINK;
    exchange->is_clear = exchange_is_clear(elements, pair.p, pair.q, exchange);
    return judgement;
}

static void judge_batch(void *user, uint64_t batch, uint32_t worker)
{
    (void)worker;
    struct refinement *work = user;
    const struct pair *pairs = work->pairs.items;
    size_t first = batch * BATCH, end = first + BATCH;
    if (work->elements->host->cancelled(work->elements->host))
        return;
    for (size_t i = first; i < end && i < work->pairs.count; i++)
        work->judgements[i] = judge(work, pairs[i]);
}

/* --- acting on it --- */

static bool add_pair(struct refinement *work, uint32_t p, uint32_t q)
{
    const ps_host *host = work->elements->host;
    if (!array_reserve(host, &work->children, 1, sizeof(struct pair), "radiosity links"))
        return false;
    ((struct pair *)work->children.items)[work->children.count++] = (struct pair){p, q};
    return true;
}

static bool add_self(struct refinement *work, uint32_t index)
{
    uint32_t child = elements_at(work->elements, index)->child;
    return add_pair(work, child, child) && add_pair(work, child, child + 1) &&
           add_pair(work, child + 1, child + 1);
}

/* Replaces a pair by those of one element's children. */
static bool divide_pair(struct refinement *work, struct pair pair)
{
    struct elements *elements = work->elements;
    uint32_t whole = larger_of(elements, pair), other = whole == pair.p ? pair.q : pair.p;
    if (pair.p == pair.q)
        return add_self(work, pair.p);
    if (elements_at(elements, whole)->child_count == 0 && !elements_divide(elements, whole))
        return false;
    const struct element *parts = elements_at(elements, whole);
    for (uint32_t i = 0; i < parts->child_count; i++)
        if (!add_pair(work, parts->child + i, other))
            return false;
    return true;
}

static bool add_link(struct refinement *work, struct pair pair, const struct exchange *exchange)
{
    const ps_host *host = work->elements->host;
    if (!array_reserve(host, &work->linked, 1, sizeof(struct pair_link), "radiosity links"))
        return false;
    ((struct pair_link *)work->linked.items)[work->linked.count++] =
        (struct pair_link){pair.p, pair.q, exchange->value, exchange->is_clear};
    return true;
}

/* In the pairs' order, whichever thread judged them. */
static ps_result act(struct refinement *work)
{
    struct elements *elements = work->elements;
    const struct pair *pairs = work->pairs.items;
    size_t first_new = elements->tree.count;
    bool good = true;
    work->children.count = 0;
    for (size_t i = 0; good && i < work->pairs.count; i++) {
        const struct judgement *judgement = &work->judgements[i];
        if (judgement->verdict == DIVIDE)
            good = divide_pair(work, pairs[i]);
        else if (judgement->verdict == LINK)
            good = add_link(work, pairs[i], &judgement->exchange);
    }
    if (good && elements->tree.count > first_new) {
        lighting_add(elements, first_new, elements->tree.count);
        good = find_brightness(work, first_new);
    }
    struct array done = work->pairs;
    work->pairs = work->children;
    work->children = done;
    return good ? PS_OK : PS_ERROR_MEMORY;
}

static ps_result take_round(struct refinement *work)
{
    const ps_host *host = work->elements->host;
    size_t count = work->pairs.count;
    /* Each pair becomes four at most. */
    work->is_full = work->linked.count + 4 * count > work->setting->most / 2;
    work->judgements = host->allocate(host, count * sizeof *work->judgements, "radiosity links");
    if (!work->judgements)
        return PS_ERROR_MEMORY;
    host->parallel_for(host, (count + BATCH - 1) / BATCH, judge_batch, work);
    ps_result result = host->cancelled(host) ? PS_CANCELLED : act(work);
    host->release(host, work->judgements);
    work->judgements = NULL;
    return result;
}

/* --- by receivers --- */

static ps_result sort_links(const struct refinement *work, struct links *links)
{
    const struct elements *elements = work->elements;
    const ps_host *host = elements->host;
    const struct pair_link *linked = work->linked.items;
    size_t count = elements->tree.count;
    links->count = 2 * work->linked.count;
    links->list = host->allocate(host, (links->count + 1) * sizeof *links->list, "radiosity links");
    links->starts = host->allocate(host, (count + 2) * sizeof *links->starts, "radiosity links");
    if (!links->list || !links->starts)
        return PS_ERROR_MEMORY;
    uint64_t *next = links->starts + 1; /* one behind: filling moves each to its end */
    memset(links->starts, 0, (count + 2) * sizeof *links->starts);
    for (size_t i = 0; i < work->linked.count; i++) {
        next[linked[i].p + 1]++;
        next[linked[i].q + 1]++;
    }
    for (size_t i = 1; i <= count; i++)
        next[i] += next[i - 1];
    for (size_t i = 0; i < work->linked.count; i++) {
        struct pair_link l = linked[i];
        links->list[next[l.p]++] =
            (struct link){l.q, l.is_clear, l.exchange / elements_at(elements, l.p)->area};
        links->list[next[l.q]++] =
            (struct link){l.p, l.is_clear, l.exchange / elements_at(elements, l.q)->area};
    }
    return PS_OK;
}

ps_result links_create(struct elements *elements, const struct links_setting *setting,
                       struct links *links)
{
    const ps_host *host = elements->host;
    struct refinement work = {.elements = elements, .setting = setting};
    *links = (struct links){.host = host};
    measure_light(&work);
    ps_result result = find_brightness(&work, 0) && add_pair(&work, 0, 0) ? PS_OK : PS_ERROR_MEMORY;
    struct array first = work.pairs;
    work.pairs = work.children;
    work.children = first;
    for (int round = 1; result == PS_OK && work.pairs.count > 0; round++) {
        result = take_round(&work);
        links->cut_short |= work.is_full;
        host->progress(host, 1.0 - 8.0 / (8.0 + round));
    }
    if (result == PS_OK)
        result = sort_links(&work, links);
    host->release(host, work.brightness.items);
    host->release(host, work.pairs.items);
    host->release(host, work.children.items);
    host->release(host, work.linked.items);
    return result;
}

void links_release(struct links *links)
{
    if (!links->host)
        return;
    links->host->release(links->host, links->list);
    links->host->release(links->host, links->starts);
    *links = (struct links){.host = NULL};
}
