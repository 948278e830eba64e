ridgeline_test(jobs
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/jobs_job.cpp ${CMAKE_CURRENT_LIST_DIR}/jobs_system.cpp
            ${CMAKE_CURRENT_LIST_DIR}/jobs_continuation.cpp ${CMAKE_CURRENT_LIST_DIR}/jobs_parallel_for.cpp
            ${CMAKE_CURRENT_LIST_DIR}/jobs_mailbox.cpp ${CMAKE_CURRENT_LIST_DIR}/jobs_queue.cpp
    LINKS ridgeline::jobs
    LABELS unit property threads)
# Alone, since it replaces operator new.
ridgeline_test(jobs_allocation
    SOURCES ${CMAKE_CURRENT_LIST_DIR}/jobs_allocation.cpp
    LINKS ridgeline::jobs ridgeline::allocation_counter
    LABELS unit threads)
