#include "support/display_picture.h"

#include "support/one_strategy.h"

#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

void run_display(const char *choice, uint32_t threads, const ps_display_view *picture,
                 ps_result expected)
{
    struct bare_host bare;
    bare_host_create(&bare, threads);
    bare.cancelled = expected == PS_CANCELLED;
    struct strategy strategy = strategy_of(choice);
    const union strategy_table *table = &strategy.type->table;
    ps_result (*run)(const void *, const ps_host *, const ps_display_view *) =
        strategy.type->kind == PS_BLOOM ? table->bloom.spread : table->tonemap.map;
    assert_non_null(run);
    assert_int_equal(strategy_start(&strategy, &bare.host), PS_OK);
    assert_int_equal(run(strategy.state, &bare.host, picture), expected);
    assert_int_equal(bare.live_allocations, 0);
    strategy_release(&strategy);
    bare_host_release(&bare);
}
