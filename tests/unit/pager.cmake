ridgeline_test(pager
    SOURCES unit/pager_fault.cpp unit/pager_fixture.cpp unit/pager_ram_ring.cpp unit/pager_read_group.cpp
            unit/pager_requests.cpp unit/pager_residency.cpp unit/pager_shutdown.cpp unit/pager_victims.cpp
    LINKS ridgeline::pager
    LABELS unit threads)

ridgeline_test(pager_walks
    SOURCES unit/pager_fixture.cpp unit/pager_walks.cpp
    LINKS ridgeline::pager
    LABELS property threads)

# Alone, because it counts every allocation of the program.
ridgeline_test(pager_steady_state
    SOURCES unit/pager_fixture.cpp unit/pager_steady_state.cpp
    LINKS ridgeline::pager ridgeline::allocation_counter
    LABELS unit threads)
