// COLMAP's commands, run one at a time with all that they say kept. Internal to photos/.
#pragma once

#include <deque>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "photos/find_colmap.h"
#include "photos/folder_lock.h"
#include "progress.h"

namespace treerec {

// What an option is called, by COLMAP's versions.
using OptionNames = std::vector<const char*>;

// What a command is called with.
struct ColmapCall {
    std::string command;
    std::vector<std::string> settings;  // options that its result depends on
    std::vector<std::string> places;    // those that name files, and threads
};

// How a command ended.
struct ColmapEnd {
    ChildEnd end;
    std::deque<std::string> last_lines;
};

class ColmapJob {
  public:
    // log: the file that everything is added to. Throws Error where it can't be written.
    ColmapJob(Colmap colmap, const std::string& log, FolderLock& lock, Progress* progress);

    const Colmap& colmap() const { return colmap_; }
    Progress* progress() const { return progress_; }

    // Adds the first of `names` that the command knows, and its value; nothing where it knows none: COLMAP
    // ends at an option that it does not know.
    void set(std::vector<std::string>& words, const std::string& command, const OptionNames& names,
             const std::string& value);

    // Throws Cancelled, or Error where the program can't be started.
    ColmapEnd run(const ColmapCall& call, const std::function<void(const std::string&)>& on_line);

    void note(const std::string& line);

    // A sentence on a command that failed.
    Error failure(const ColmapCall& call, const ColmapEnd& end) const;

  private:
    Colmap colmap_;
    std::string log_path_;
    std::ofstream log_;
    FolderLock& lock_;
    Progress* progress_;
};

// "[12/71]" in a line, or "[2/8, 3/8]" of blocks (as the 11th of 64); all is 0 where there is none.
struct CountInLine {
    size_t done = 0;
    size_t all = 0;
};
CountInLine count_in(const std::string& line);

// The number that follows `word` and what is no digit; nothing (0) without one.
size_t number_after(const std::string& line, const std::string& word);

}  // namespace treerec
