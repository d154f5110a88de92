// Counts what operator new gives out, in this program only.
#pragma once

#include <cstddef>

namespace treerec::bench {

struct MemoryUse {
    double allocated_mb = 0.0;  // all that was asked for
    double peak_mb = 0.0;       // the most that was held at once, with what was held before
};

// Counting costs a little time: off by default.
void count_memory(bool on);
// Since the last call, or since counting began.
MemoryUse take_memory_use();

}  // namespace treerec::bench
