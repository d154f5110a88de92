#include "geometry/parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace treerec {

namespace {

std::atomic<int> requested_threads{0};

// A thread that sleeps takes some 50 us to wake, and a small scan's run has hundreds of loops. So those who
// wait for the next loop, or for its last helper, look for this long before they sleep.
constexpr std::chrono::microseconds kWatch{25};

// Until `happened()`, but not for long. It does not yield: a busy system would take the core for longer.
template <typename Happened>
void watch_for(Happened happened) {
    const auto end = std::chrono::steady_clock::now() + kWatch;
    while (!happened() && std::chrono::steady_clock::now() < end) {
    }
}

// One loop. It lies on the stack of the thread that asked for it.
class Loop {
  public:
    Loop(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body)
        : count_(count), grain_(grain), chunks_((count + grain - 1) / grain), body_(body) {}

    size_t chunks() const { return chunks_; }

    // Runs chunks until none is left.
    void work() {
        for (size_t chunk = next_++; chunk < chunks_; chunk = next_++) {
            try {
                body_(chunk * grain_, std::min(count_, (chunk + 1) * grain_));
            } catch (...) {
                const std::lock_guard lock(failure_mutex_);
                if (!failure_) failure_ = std::current_exception();
                next_ = chunks_;
            }
        }
    }

    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }

    // Both are the pool's, and changed only under its mutex.
    size_t wanted = 0;                // helpers who may still come
    std::atomic<size_t> helpers = 0;  // who are at work

  private:
    size_t count_, grain_, chunks_;
    const std::function<void(size_t, size_t)>& body_;
    std::atomic<size_t> next_{0};
    std::exception_ptr failure_;
    std::mutex failure_mutex_;
};

// Threads that wait for loops to help with: one less than loops may use, however many loops there are at
// once. Who asks for a loop works on it too, so that each of them goes on even where nobody is free to help.
class Pool {
  public:
    ~Pool() { end(); }

    void run(Loop& loop, size_t helpers) {
        {
            const std::lock_guard lock(mutex_);
            loop.wanted = helpers;
            open_.push_back(&loop);
            open_places_ += helpers;
            const size_t most = static_cast<size_t>(thread_count()) - 1;
            while (idle_ + starting_ < open_places_ && threads_.size() < most && start_thread())
                starting_++;
        }
        for (size_t i = 0; i < helpers; i++)
            called_.notify_one();
        loop.work();
        std::unique_lock lock(mutex_);
        if (loop.wanted > 0) close(loop);  // who has not come by now is not needed
        if (loop.helpers > 0) {
            lock.unlock();
            watch_for([&] { return loop.helpers == 0; });
            lock.lock();
        }
        left_.wait(lock, [&] { return loop.helpers == 0; });
    }

    void end() {
        std::vector<std::thread> threads;
        {
            const std::lock_guard lock(mutex_);
            threads.swap(threads_);
            ending_++;
        }
        called_.notify_all();
        for (std::thread& thread : threads)
            thread.join();
        const std::lock_guard lock(mutex_);
        ending_--;
    }

  private:
    // Where the system has no more threads to give, fewer do.
    bool start_thread() {
        try {
            threads_.emplace_back([this] { help(); });
            return true;
        } catch (const std::system_error&) {
            return false;
        }
    }

    void help() {
        std::unique_lock lock(mutex_);
        starting_--;
        while (true) {
            idle_++;
            if (open_places_ == 0 && ending_ == 0) {
                lock.unlock();
                watch_for([&] { return open_places_ > 0 || ending_ > 0; });
                lock.lock();
            }
            called_.wait(lock, [&] { return ending_ > 0 || !open_.empty(); });
            idle_--;
            if (open_.empty()) return;
            Loop& loop = *open_.back();
            open_places_--;
            if (--loop.wanted == 0) close(loop);
            loop.helpers++;
            lock.unlock();
            loop.work();
            lock.lock();
            if (--loop.helpers == 0) left_.notify_all();
        }
    }

    void close(Loop& loop) {
        open_places_ -= loop.wanted;
        loop.wanted = 0;
        std::erase(open_, &loop);
    }

    std::mutex mutex_;
    std::condition_variable called_, left_;
    std::vector<std::thread> threads_;
    std::vector<Loop*> open_;              // that want helpers
    std::atomic<size_t> open_places_ = 0;  // how many
    size_t idle_ = 0, starting_ = 0;
    std::atomic<int> ending_ = 0;
};

Pool& pool() {
    static Pool pool;
    return pool;
}

}  // namespace

void set_thread_count(int threads) {
    requested_threads = std::max(threads, 0);
}

int thread_count() {
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
    return 1;  // a web export without threads has none to give
#else
    // The system is asked once: that opens files.
    static const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    const int threads = requested_threads;
    return threads > 0 ? threads : cores;
#endif
}

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& body) {
    Loop loop(count, std::max<size_t>(grain, 1), body);
    const size_t workers = std::min<size_t>(loop.chunks(), static_cast<size_t>(thread_count()));
    if (workers > 1)
        pool().run(loop, workers - 1);
    else
        loop.work();
    loop.rethrow();
}

void end_idle_threads() {
    pool().end();
}

}  // namespace treerec
