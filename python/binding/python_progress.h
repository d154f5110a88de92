// Progress that is told to a Python function, and a way to run without Python's lock.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include "progress.h"

namespace treerec {

// Threads of the library call it, which do not hold Python's lock: it takes that for each call, one at a
// time.
class PythonProgress final : public Progress {
  public:
    // callback: None, or called with the fraction that is done and the stage's name; to return False cancels,
    // and what it raises does, too. Both the constructor and the destructor are called with Python's lock.
    explicit PythonProgress(nanobind::object callback);

    void update(double fraction, const char* stage) override;
    // Ctrl-C as well: Python hears it where the thread that began asks, which works along.
    bool cancelled() const override;
    // With Python's lock: raises what the callback has raised, or Ctrl-C.
    void rethrow();

  private:
    void stop_with_python_error() const;

    nanobind::object callback_;
    std::thread::id begun_by_ = std::this_thread::get_id();
    std::mutex mutex_;
    double fraction_ = 0.0;
    mutable std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
    mutable std::atomic<bool> stopped_ = false;
    mutable std::mutex raised_mutex_;
    mutable std::exception_ptr raised_;
};

[[noreturn]] void raise_no_memory();

// What the call returns, which runs without Python's lock and must not touch its objects.
template <typename Call>
auto without_lock(PythonProgress& progress, Call call) {
    try {
        auto result = [&] {
            const nanobind::gil_scoped_release release;
            return call();
        }();
        progress.rethrow();
        return result;
    } catch (const Cancelled&) {
        progress.rethrow();
        throw;
    } catch (const std::bad_alloc&) {
        raise_no_memory();
    }
}

}  // namespace treerec
