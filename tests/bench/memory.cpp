#include "memory.h"

#ifdef __APPLE__
#include <malloc/malloc.h>
#else
#include <malloc.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<bool> counting{false};
std::atomic<int64_t> held{0}, peak{0}, allocated{0};

int64_t size_of(void* block) {
#if defined(__APPLE__)
    return static_cast<int64_t>(malloc_size(block));
#elif defined(_WIN32)
    return static_cast<int64_t>(_msize(block));
#else
    return static_cast<int64_t>(malloc_usable_size(block));
#endif
}

void* counted(void* block) {
    if (!block) throw std::bad_alloc();
    if (!counting.load(std::memory_order_relaxed)) return block;
    const int64_t size = size_of(block);
    allocated.fetch_add(size, std::memory_order_relaxed);
    const int64_t now = held.fetch_add(size, std::memory_order_relaxed) + size;
    int64_t before = peak.load(std::memory_order_relaxed);
    while (now > before && !peak.compare_exchange_weak(before, now, std::memory_order_relaxed)) {
    }
    return block;
}

void discount(void* block) {
    if (block && counting.load(std::memory_order_relaxed))
        held.fetch_sub(size_of(block), std::memory_order_relaxed);
}

}  // namespace

void* operator new(size_t size) {
    return counted(std::malloc(std::max<size_t>(size, 1)));
}

void* operator new(size_t size, std::align_val_t alignment) {
    const size_t step = static_cast<size_t>(alignment);
    return counted(std::aligned_alloc(step, (std::max<size_t>(size, 1) + step - 1) / step * step));
}

void operator delete(void* block) noexcept {
    discount(block);
    std::free(block);
}

void operator delete(void* block, size_t) noexcept {
    operator delete(block);
}

void operator delete(void* block, std::align_val_t) noexcept {
    operator delete(block);
}

void operator delete(void* block, size_t, std::align_val_t) noexcept {
    operator delete(block);
}

namespace treerec::bench {

void count_memory(bool on) {
    counting = on;
    if (!on) return;
    held = peak = allocated = 0;
}

MemoryUse take_memory_use() {
    const auto megabytes = [](int64_t bytes) { return static_cast<double>(bytes) / 1e6; };
    const MemoryUse use{megabytes(allocated.exchange(0)), megabytes(peak.load())};
    peak = held.load();
    return use;
}

}  // namespace treerec::bench
