#include "cli/large_pages.h"

#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace treerec {

#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)

void use_large_pages() {
    constexpr int kRoom = 256 << 20;       // bytes of addresses that are asked for at once,
    constexpr int kLaterRoom = 4 << 20;    // and when these are used up
    constexpr int kOwnMapping = 32 << 20;  // bytes: larger arrays are given back when they are freed
    constexpr size_t kAny = 256 << 10;     // more than the first heap has room for
    constexpr uintptr_t kPage = uintptr_t{2} << 20;
    mallopt(M_MMAP_THRESHOLD, kOwnMapping);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    mallopt(M_TOP_PAD, kRoom);
    const auto begin = reinterpret_cast<uintptr_t>(sbrk(0));
    void* volatile grown = std::malloc(kAny);
    std::free(grown);
    const auto end = reinterpret_cast<uintptr_t>(sbrk(0));
    mallopt(M_TOP_PAD, kLaterRoom);
    // Whether it is taken or not changes the speed alone.
    const uintptr_t first = (begin + kPage - 1) / kPage * kPage;
    if (first < end) madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

#else

void use_large_pages() {}

#endif

}  // namespace treerec
