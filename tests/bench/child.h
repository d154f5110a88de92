// Runs another program and measures it.
#pragma once

#include <string>
#include <vector>

namespace treerec::bench {

struct ChildRun {
    int exit_code = 0;  // 128 + the signal that killed it
    double wall_s = 0.0;
    double cpu_s = 0.0;    // user and system, of all its threads
    double peak_mb = 0.0;  // resident
    std::string output;    // stdout and stderr
};

// words: the program (looked for as given, then in PATH) and its arguments. one_core: on a single processor,
// where the system can do that. Throws treerec::Error if it cannot be started.
ChildRun run_child(const std::vector<std::string>& words, bool one_core = false);

// A new folder for files in between, gone with this object.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::string file(const std::string& name) const { return path_ + "/" + name; }

  private:
    std::string path_;
};

// The middle one, or the mean of the middle two. values: not empty.
double median(std::vector<double> values);

}  // namespace treerec::bench
