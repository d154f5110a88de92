// Another program at work: started without a shell, listened to, and ended together with us.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "photos/folder_lock.h"
#include "progress.h"

namespace treerec {

// All text is UTF-8.
struct ChildCommand {
    std::string program;                                           // the file itself, with its folder
    std::vector<std::string> arguments;                            // as the program shall get them
    std::vector<std::pair<std::string, std::string>> environment;  // name and value, beside what we have
    double most_seconds = 0.0;   // until it is ended; 0: as long as it likes
    FolderLock* lock = nullptr;  // is held until the program ends, even where we end before
};

struct ChildEnd {
    int code = 0;          // its exit code, where no signal ended it
    int signal = 0;        // that ended it (not on Windows)
    bool overdue = false;  // it was ended after most_seconds

    bool well() const { return code == 0 && signal == 0 && !overdue; }
};

// Runs a program to its end. on_line: gets what it prints, on stdout and stderr together, line by line and
// without the line's end, in this thread. Where `progress` says cancelled, or on_line throws, the program and
// all that it started are killed. Throws Error where it can't be started, or Cancelled.
ChildEnd run_child(const ChildCommand& command, const std::function<void(const std::string& line)>& on_line,
                   const Progress* progress = nullptr);

// Cuts what a program prints into lines. '\r' ends one, too: programs write over their last line with it.
class LineCutter {
  public:
    explicit LineCutter(const std::function<void(const std::string&)>& on_line) : on_line_(on_line) {}

    void take(const char* bytes, size_t count) {
        for (size_t i = 0; i < count; i++) {
            if (bytes[i] == '\n' || bytes[i] == '\r')
                flush();
            else if (line_.size() < kLongest)
                line_ += bytes[i];
        }
    }
    void flush() {
        if (line_.empty()) return;
        const std::string line = std::exchange(line_, {});
        on_line_(line);
    }

  private:
    static constexpr size_t kLongest = 4096;  // what is beyond is left out
    const std::function<void(const std::string&)>& on_line_;
    std::string line_;
};

}  // namespace treerec
