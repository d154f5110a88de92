// On Linux, macOS and their like; for Windows see child_process_windows.cpp.
#ifndef _WIN32

#include "photos/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>

#include "error.h"

#ifdef __APPLE__
#include <crt_externs.h>
#else
extern char** environ;
#endif

namespace treerec {

namespace {

constexpr int kListenMs = 50;
constexpr int kLockAt = 3;  // the descriptor under which a started program holds a FolderLock

class Descriptor {
  public:
    Descriptor() = default;
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    void reset(int number = -1) {
        if (number_ >= 0) close(number_);
        number_ = number;
    }
    int get() const { return number_; }

  private:
    int number_ = -1;
};

// Both ends above the descriptors that a started program gets, and not inherited.
void make_pipe(Descriptor& read_end, Descriptor& write_end) {
    int ends[2];
    if (pipe(ends) != 0) throw Error(std::string("No pipe could be made: ") + std::strerror(errno) + ".");
    const Descriptor first(ends[0]), second(ends[1]);
    read_end.reset(fcntl(ends[0], F_DUPFD_CLOEXEC, 10));
    write_end.reset(fcntl(ends[1], F_DUPFD_CLOEXEC, 10));
    if (read_end.get() < 0 || write_end.get() < 0) throw Error("Too many files are open; close some.");
}

// Ours, with what the command adds, as "NAME=value".
std::vector<std::string> environment_of(const ChildCommand& command) {
#ifdef __APPLE__
    char** const ours = *_NSGetEnviron();  // a library has no environ there
#else
    char** const ours = environ;
#endif
    std::vector<std::string> words;
    for (char** at = ours; *at; at++) {
        const std::string word = *at;
        bool replaced = false;
        for (const auto& [name, value] : command.environment)
            replaced = replaced || word.starts_with(name + "=");
        if (!replaced) words.push_back(word);
    }
    for (const auto& [name, value] : command.environment)
        words.push_back(name + "=" + value);
    return words;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

// In a group of its own, which is killed with it unless it ended.
class Running {
  public:
    Running(const ChildCommand& command, int output) {
        std::vector<std::string> words{command.program};
        words.insert(words.end(), command.arguments.begin(), command.arguments.end());
        std::vector<std::string> environment = environment_of(command);
        posix_spawn_file_actions_t files;
        posix_spawnattr_t how;
        posix_spawn_file_actions_init(&files);
        posix_spawnattr_init(&how);
        posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
        if (command.lock) posix_spawn_file_actions_adddup2(&files, command.lock->descriptor(), kLockAt);
        // What we ignore or block, such as a pipe that nobody reads any more, shall end it.
        sigset_t none, usual;
        sigemptyset(&none);
        sigemptyset(&usual);
        for (const int signal : {SIGPIPE, SIGINT, SIGTERM, SIGHUP, SIGCHLD})
            sigaddset(&usual, signal);
        posix_spawnattr_setsigmask(&how, &none);
        posix_spawnattr_setsigdefault(&how, &usual);
        posix_spawnattr_setpgroup(&how, 0);
        posix_spawnattr_setflags(&how,
                                 POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        const int failure = posix_spawn(&id_, command.program.c_str(), &files, &how,
                                        pointers_to(words).data(), pointers_to(environment).data());
        posix_spawn_file_actions_destroy(&files);
        posix_spawnattr_destroy(&how);
        if (failure != 0)
            throw Error("'" + command.program + "' could not be started: " + std::strerror(failure) + ".");
        if (command.lock) command.lock->note_child(id_);
    }
    ~Running() { end(); }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    // It stays known to the system until end(), so that nobody else gets its number.
    bool ended() const {
        siginfo_t info{};
        return waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
               info.si_pid == id_;
    }
    // Ends it, and what it started.
    ChildEnd end() {
        if (end_) return *end_;
        end_.emplace();
        const bool by_itself = ended();
        kill(-id_, SIGKILL);
        int status = 0;
        pid_t got = 0;
        do
            got = waitpid(id_, &status, 0);
        while (got < 0 && errno == EINTR);
        if (got == id_ && WIFSIGNALED(status)) end_->signal = WTERMSIG(status);
        // Where somebody else took its end, nobody knows how that was.
        end_->code = got != id_ ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 0;
        end_->overdue = !by_itself;
        return *end_;
    }

  private:
    pid_t id_ = 0;
    std::optional<ChildEnd> end_;
};

}  // namespace

ChildEnd run_child(const ChildCommand& command, const std::function<void(const std::string& line)>& on_line,
                   const Progress* progress) {
    Descriptor output, input;
    make_pipe(output, input);
    Running running(command, input.get());
    input.reset();
    LineCutter lines(on_line);
    const auto start = std::chrono::steady_clock::now();
    const auto overdue = [&] {
        const std::chrono::duration<double> since = std::chrono::steady_clock::now() - start;
        return command.most_seconds > 0.0 && since.count() > command.most_seconds;
    };
    bool open = true;
    while (open && !overdue()) {
        if (progress) progress->check();
        // Asked before the last look at its output, so that nothing is missed; what it left running in the
        // background may keep that open.
        const bool over = running.ended();
        pollfd ready{output.get(), POLLIN, 0};
        const int count = poll(&ready, 1, over ? 0 : kListenMs);
        if (count < 0 && errno != EINTR) break;
        if (count <= 0) {
            if (over) break;
            continue;
        }
        char bytes[4096];
        const ssize_t got = read(output.get(), bytes, sizeof bytes);
        if (got > 0)
            lines.take(bytes, static_cast<size_t>(got));
        else if (got == 0 || errno != EINTR)
            open = false;
    }
    lines.flush();
    // A program may close its output before it ends.
    while (!running.ended() && !overdue()) {
        if (progress) progress->check();
        poll(nullptr, 0, kListenMs);
    }
    return running.end();
}

}  // namespace treerec

#endif
