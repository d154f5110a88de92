#include "photos/folder_lock.h"

#include <chrono>
#include <thread>

#include "error.h"
#include "file_bytes.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#endif

namespace treerec {

namespace {

// What a killed run has left needs a moment to end.
constexpr int kTries = 100;
constexpr std::chrono::milliseconds kBetweenTries{50};

Error busy(const std::string& path) {
    return Error("Another run works in '" + utf8_of(path_of(path).parent_path()) +
                 "'; wait for its end, or name another folder.");
}

Error locked_out(const std::string& path) {
    return Error("'" + path + "' cannot be written; check that its folder is yours to write.");
}

}  // namespace

#ifdef _WIN32

FolderLock::FolderLock(const std::string& path) {
    for (int i = 0; i < kTries; i++) {
        handle_ = CreateFileW(path_of(path).c_str(), GENERIC_READ | GENERIC_WRITE, 0, nullptr, OPEN_ALWAYS,
                              FILE_ATTRIBUTE_NORMAL, nullptr);
        if (handle_ != INVALID_HANDLE_VALUE) return;
        if (GetLastError() != ERROR_SHARING_VIOLATION) throw locked_out(path);
        std::this_thread::sleep_for(kBetweenTries);
    }
    throw busy(path);
}

FolderLock::~FolderLock() {
    CloseHandle(handle_);
}

#else

namespace {

struct Holders {
    long owner = 0;
    long group = 0;  // of processes that the owner started
};

Holders holders_of(int descriptor) {
    char text[64] = {};
    Holders holders;
    if (pread(descriptor, text, sizeof text - 1, 0) > 0 &&
        std::sscanf(text, "%ld %ld", &holders.owner, &holders.group) < 1)
        holders = {};
    return holders;
}

void write_holders(int descriptor, const Holders& holders) {
    char text[64];
    const int size = std::snprintf(text, sizeof text, "%ld %ld\n", holders.owner, holders.group);
    // Where the disk is full, the lock still holds.
    if (ftruncate(descriptor, 0) == 0 && pwrite(descriptor, text, static_cast<size_t>(size), 0) < 0) return;
}

}  // namespace

FolderLock::FolderLock(const std::string& path) {
    const int opened = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (opened < 0) throw locked_out(path);
    // Above those that a program's own files get.
    descriptor_ = fcntl(opened, F_DUPFD_CLOEXEC, 10);
    close(opened);
    if (descriptor_ < 0) throw locked_out(path);
    for (int i = 0; i < kTries; i++) {
        // A file system that knows no locks lets everybody in.
        if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || (errno != EWOULDBLOCK && errno != EINTR)) {
            write_holders(descriptor_, {getpid(), 0});
            return;
        }
        const Holders holders = holders_of(descriptor_);
        const bool orphaned =
            holders.owner > 0 && kill(static_cast<pid_t>(holders.owner), 0) != 0 && errno == ESRCH;
        if (!orphaned && holders.owner > 0) break;
        // The lock is held, so the group is still the one that was started.
        if (orphaned && holders.group > 1) kill(static_cast<pid_t>(-holders.group), SIGKILL);
        std::this_thread::sleep_for(kBetweenTries);
    }
    close(descriptor_);
    throw busy(path);
}

FolderLock::~FolderLock() {
    // Closing alone would leave it with whatever has inherited the file, such as a killed program that takes
    // a moment to die.
    flock(descriptor_, LOCK_UN);
    close(descriptor_);
}

void FolderLock::note_child(int64_t group) const {
    write_holders(descriptor_, {getpid(), static_cast<long>(group)});
}

#endif

}  // namespace treerec
