#include "cli/terminal_progress.h"

#include <algorithm>
#include <csignal>
#include <cstdio>

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

namespace treerec {

namespace {

// Of lines where there is no terminal.
constexpr std::chrono::seconds kBetweenCounts{10};

volatile std::sig_atomic_t interrupted = 0;

extern "C" void on_interrupt(int signal) {
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}

bool stderr_is_terminal() {
#ifdef _WIN32
    return _isatty(_fileno(stderr)) != 0;
#else
    return isatty(STDERR_FILENO) != 0;
#endif
}

}  // namespace

void listen_for_interrupt() {
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
}

TerminalProgress::TerminalProgress(bool quiet) : quiet_(quiet), terminal_(stderr_is_terminal()) {}

TerminalProgress::~TerminalProgress() {
    clear();
}

bool TerminalProgress::cancelled() const {
    return interrupted != 0;
}

void TerminalProgress::update(double fraction, const char* stage) {
    if (quiet_) return;
    const std::lock_guard lock(mutex_);
    fraction_ = std::max(fraction_, std::clamp(fraction, 0.0, 1.0));
    const bool new_stage = stage_ != stage;
    if (new_stage) {
        stage_ = stage;
        counted_.clear();
        last_count_ = std::chrono::steady_clock::now();
    }
    if (!terminal_) {
        if (new_stage) std::fprintf(stderr, "%s\n", stage);
        return;
    }
    const auto now = std::chrono::steady_clock::now();
    if (!new_stage && now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    draw();
}

void TerminalProgress::count(size_t done, size_t all) {
    if (quiet_) return;
    const std::lock_guard lock(mutex_);
    counted_ = " " + std::to_string(done) + " of " + std::to_string(all);
    if (terminal_) return draw();
    const auto now = std::chrono::steady_clock::now();
    if (done < all && now - last_count_ < kBetweenCounts) return;
    last_count_ = now;
    std::fprintf(stderr, "%s%s\n", stage_.c_str(), counted_.c_str());
}

void TerminalProgress::draw() {
    constexpr size_t kWidth = 30;
    const size_t full = static_cast<size_t>(fraction_ * kWidth);
    std::string line = "[" + std::string(full, '#') + std::string(kWidth - full, ' ') + "] " +
                       std::to_string(static_cast<int>(100.0 * fraction_)) + " % " + stage_ + counted_;
    const size_t length = line.size();
    if (length < drawn_) line.append(drawn_ - length, ' ');
    drawn_ = length;
    std::fprintf(stderr, "\r%s", line.c_str());
    std::fflush(stderr);
}

void TerminalProgress::clear() {
    const std::lock_guard lock(mutex_);
    if (drawn_ == 0) return;
    std::fprintf(stderr, "\r%s\r", std::string(drawn_, ' ').c_str());
    std::fflush(stderr);
    drawn_ = 0;
}

}  // namespace treerec
