#include "child.h"

#ifndef _WIN32
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sched.h>
#endif
#endif

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "error.h"

namespace treerec::bench {

#ifdef _WIN32

ChildRun run_child(const std::vector<std::string>&, bool) {
    throw Error("Programs are measured on Linux and macOS only.");
}

ScratchFolder::ScratchFolder() : path_(std::filesystem::temp_directory_path().string() + "/treerec_bench") {
    std::filesystem::create_directories(path_);
}

#else

namespace {

double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

// In the new process: never returns.
[[noreturn]] void become(const std::vector<std::string>& words, int output, bool one_core) {
#ifdef __linux__
    if (one_core) {
        cpu_set_t set;
        CPU_ZERO(&set);
        const int here = sched_getcpu();
        CPU_SET(here >= 0 ? here : 0, &set);
        sched_setaffinity(0, sizeof set, &set);
    }
#else
    (void)one_core;
#endif
    const int nothing = open("/dev/null", O_RDONLY);
    if (nothing >= 0) dup2(nothing, STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
}

}  // namespace

ChildRun run_child(const std::vector<std::string>& words, bool one_core) {
    int ends[2];
    if (pipe(ends) != 0) throw Error(std::string("No pipe: ") + std::strerror(errno) + ".");
    const auto start = std::chrono::steady_clock::now();
    const pid_t child = fork();
    if (child < 0) throw Error(std::string("No process: ") + std::strerror(errno) + ".");
    if (child == 0) {
        close(ends[0]);
        become(words, ends[1], one_core);
    }
    close(ends[1]);
    ChildRun run;
    char buffer[4096];
    for (;;) {
        const ssize_t count = read(ends[0], buffer, sizeof buffer);
        if (count > 0)
            run.output.append(buffer, static_cast<size_t>(count));
        else if (count == 0 || errno != EINTR)
            break;
    }
    close(ends[0]);
    int status = 0;
    rusage usage{};
    while (wait4(child, &status, 0, &usage) < 0)
        if (errno != EINTR) throw Error("'" + words[0] + "' was lost.");
    run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
#ifdef __APPLE__
    run.peak_mb = static_cast<double>(usage.ru_maxrss) / 1e6;
#else
    run.peak_mb = static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
#endif
    run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    if (run.exit_code == 127)
        throw Error("'" + words[0] + "' could not be started. Is it there, and is it a program?");
    return run;
}

ScratchFolder::ScratchFolder() {
    path_ = (std::filesystem::temp_directory_path() / "treerec_bench.XXXXXX").string();
    if (!mkdtemp(path_.data())) throw Error("No folder could be made for the files in between.");
}

#endif

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;  // what is left behind lies in the system's folder for such files
    std::filesystem::remove_all(path_, ignored);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t middle = values.size() / 2;
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace treerec::bench
