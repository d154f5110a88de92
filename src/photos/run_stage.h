// What one stage of COLMAP's work was begun with, and whether it ended: a small file that outlives a kill.
#pragma once

#include <string>
#include <vector>

#include "photos/photo_folder.h"

namespace treerec {

// Everything that a stage's result depends on, as one line of text.
std::string photos_as_text(const PhotoFolder& photos);

class RunStage {
  public:
    // path: of the mark's file. basis: what the result depends on.
    RunStage(const std::string& path, const std::string& basis);

    // Of the same basis.
    bool begun() const { return begun_; }
    bool done() const { return done_; }
    const std::string& note() const { return note_; }

    // note: a line to find again, with the same basis, after a kill.
    void begin(const std::string& note = "");
    void finish(const std::string& note = "");

  private:
    void write();

    std::string path_;
    std::string basis_;
    std::string note_;
    bool begun_ = false;
    bool done_ = false;
};

}  // namespace treerec
