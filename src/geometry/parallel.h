// A loop on several threads whose result does not depend on how many there are.
#pragma once

#include <cstddef>
#include <functional>

namespace treerec {

// How many threads parallel_for uses; 0 (the default) means one per core.
void set_thread_count(int threads);
int thread_count();

// Calls body(begin, end) for consecutive chunks of 0..count, each at most `grain` long, on several threads.
// body must write only what belongs to its own indices, and may itself call this. The first exception is
// thrown again here. The threads stay for the next loop.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

// Ends the threads that wait for a loop; the next loop starts new ones. A library must do so before it is
// unloaded: threads can't be joined while that happens on every system.
void end_idle_threads();

}  // namespace treerec
