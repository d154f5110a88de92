// A loop on several threads whose result does not depend on how many there are.
#pragma once

#include <cstddef>
#include <functional>

namespace treerec {

// How many threads parallel_for uses; 0 (the default) means one per core.
void set_thread_count(int threads);
int thread_count();

// Calls body(begin, end) for consecutive chunks of 0..count, each at most `grain` long, on several threads.
// body must write only what belongs to its own indices. The first exception is thrown again here.
void parallel_for(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body);

}  // namespace treerec
