// One run at a time in a folder.
#pragma once

#include <cstdint>
#include <string>

namespace treerec {

// Held from construction on. A program that run_child() started with it holds it, too: where we were killed
// and it goes on, the next one to want the folder ends that program first.
class FolderLock {
  public:
    // path: of the lock's file, which stays there. Throws Error where another run works in its folder.
    explicit FolderLock(const std::string& path);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

#ifndef _WIN32
    // What a started program inherits.
    int descriptor() const {
        return descriptor_;
    }
    // Its group of processes, to be ended where we can't do it any more.
    void note_child(int64_t group) const;

  private:
    int descriptor_ = -1;
#else
  private:
    void* handle_ = nullptr;
#endif
};

}  // namespace treerec
