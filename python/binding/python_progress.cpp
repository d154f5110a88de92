#include "python_progress.h"

#include <algorithm>

namespace nb = nanobind;

namespace treerec {

namespace {

constexpr std::chrono::milliseconds kBetweenSignals{50};

}  // namespace

PythonProgress::PythonProgress(nb::object callback) : callback_(std::move(callback)) {}

void PythonProgress::update(double fraction, const char* stage) {
    if (callback_.is_none() || stopped_) return;
    const std::lock_guard lock(mutex_);
    fraction_ = std::max(fraction_, std::clamp(fraction, 0.0, 1.0));
    const nb::gil_scoped_acquire acquire;
    try {
        if (callback_(fraction_, stage).ptr() == Py_False) stopped_ = true;
    } catch (const nb::python_error&) {
        stop_with_python_error();
    }
}

bool PythonProgress::cancelled() const {
    if (stopped_) return true;
    if (std::this_thread::get_id() != begun_by_) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_ < kBetweenSignals) return false;
    asked_ = now;
    const nb::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() == 0) return false;
    try {
        throw nb::python_error();
    } catch (const nb::python_error&) {
        stop_with_python_error();
    }
    return true;
}

// Of the exception that is being handled; the first one counts.
void PythonProgress::stop_with_python_error() const {
    const std::lock_guard lock(raised_mutex_);
    if (!raised_) raised_ = std::current_exception();
    stopped_ = true;
}

void PythonProgress::rethrow() {
    if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

void raise_no_memory() {
    PyErr_SetString(PyExc_MemoryError,
                    "There is not enough memory for this; thin the scan (spacing) or give it fewer points.");
    throw nb::python_error();
}

}  // namespace treerec
