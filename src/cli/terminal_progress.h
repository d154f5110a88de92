// Shows a job's progress on stderr and hears Ctrl-C.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "progress.h"

namespace treerec {

// On a terminal a bar that is drawn over itself; elsewhere one line per stage, and now and then one that
// counts. Not copied.
class TerminalProgress final : public Progress {
  public:
    // quiet: shows nothing; Ctrl-C is heard all the same.
    explicit TerminalProgress(bool quiet);
    ~TerminalProgress() override;
    TerminalProgress(const TerminalProgress&) = delete;
    TerminalProgress& operator=(const TerminalProgress&) = delete;

    void update(double fraction, const char* stage) override;
    void count(size_t done, size_t all) override;
    bool cancelled() const override;

    // Wipes the bar, so that something else can be printed.
    void clear();

  private:
    void draw();

    std::mutex mutex_;
    bool quiet_;
    bool terminal_;
    double fraction_ = 0.0;
    std::string stage_;
    std::string counted_;  // " 12 of 71", of the stage
    size_t drawn_ = 0;     // characters of the bar on the screen
    std::chrono::steady_clock::time_point last_, last_count_;
};

// Lets the first Ctrl-C (or a polite kill) cancel the job; a second one ends the program at once.
void listen_for_interrupt();

}  // namespace treerec
