// Programs that we start: what they get, what is heard of them, and that they end.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "cli_runner.h"
#include "geometry/random.h"
#include "photos/child_process.h"
#include "photos/colmap_job.h"

namespace treerec {
namespace {

using test::InFolder;
using test::StopAfter;
using namespace std::chrono_literals;

class ChildProcess : public InFolder {
  protected:
    ChildCommand shell(const std::string& script) const {
        ChildCommand command;
        command.program = "/bin/sh";
        command.arguments = {"-c", script, "name"};
        return command;
    }
    std::vector<std::string> lines_;
    std::function<void(const std::string&)> keep_ = [this](const std::string& line) {
        lines_.push_back(line);
    };
};

bool lives(int process) {
    return ::kill(process, 0) == 0;
}

TEST_F(ChildProcess, GetsAnyWordsAsTheyAre) {
    Random random(3);
    const std::string letters = " \"'\\$`*?&|;<>(){}[]~#!%^абвжЯ日é-=";
    for (int i = 0; i < 30; i++) {
        std::vector<std::string> words;
        for (size_t k = random.below(6); k-- > 0;) {
            std::string word;
            for (size_t n = random.below(12); n-- > 0;)
                word += letters[random.below(static_cast<uint32_t>(letters.size()))];
            words.push_back(word);
        }
        ChildCommand command = shell(R"(for w in "$@"; do printf '[%s]' "$w"; done)");
        command.arguments.insert(command.arguments.end(), words.begin(), words.end());
        std::string wanted, got;
        for (const std::string& word : words)
            wanted += "[" + word + "]";
        EXPECT_TRUE(run_child(command, [&](const std::string& line) { got += line; }).well());
        EXPECT_EQ(got, wanted);
    }
}

TEST_F(ChildProcess, TellsLinesOfBothOutputsAndTheExitCode) {
    const ChildEnd end = run_child(shell("echo one; echo two >&2; printf 'three\\rfour'; exit 7"), keep_);
    EXPECT_EQ(end.code, 7);
    EXPECT_EQ(end.signal, 0);
    EXPECT_FALSE(end.well());
    EXPECT_EQ(lines_, (std::vector<std::string>{"one", "two", "three", "four"}));
}

TEST_F(ChildProcess, TellsTheSignal) {
    EXPECT_EQ(run_child(shell("kill -9 $$"), keep_).signal, 9);
}

TEST_F(ChildProcess, HearsAllOfALotOfOutput) {
    const ChildEnd end =
        run_child(shell("i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done"), keep_);
    EXPECT_TRUE(end.well());
    ASSERT_EQ(lines_.size(), 20000u);
    EXPECT_EQ(lines_.back(), "line 19999");
}

TEST_F(ChildProcess, SetsTheEnvironmentBesideOurs) {
    ::setenv("TREEREC_TEST_KEPT", "kept", 1);
    ::setenv("TREEREC_TEST_SET", "old", 1);
    ChildCommand command = shell("echo $TREEREC_TEST_KEPT $TREEREC_TEST_SET");
    command.environment = {{"TREEREC_TEST_SET", "new"}};
    run_child(command, keep_);
    ::unsetenv("TREEREC_TEST_KEPT");
    ::unsetenv("TREEREC_TEST_SET");
    EXPECT_EQ(lines_, std::vector<std::string>{"kept new"});
}

TEST_F(ChildProcess, IsEndedWithAllThatItStartedWhenCancelled) {
    const StopAfter stop(300ms);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_THROW(run_child(shell("sleep 1000 & echo $!; echo $$; wait"), keep_, &stop), Cancelled);
    EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
    ASSERT_EQ(lines_.size(), 2u);
    EXPECT_FALSE(lives(std::stoi(lines_[1])));
    // Whoever inherits the sleeper needs a moment to notice its end.
    bool gone = false;
    for (int i = 0; i < 100 && !gone; i++) {
        std::ifstream stat("/proc/" + lines_[0] + "/stat");
        std::string text;
        std::getline(stat, text);
        gone = text.empty() || text.find(") Z") != std::string::npos;
        if (!gone) std::this_thread::sleep_for(20ms);
    }
    EXPECT_TRUE(gone);
}

TEST_F(ChildProcess, IsEndedWhenItTakesTooLong) {
    ChildCommand command = shell("echo here; sleep 1000");
    command.most_seconds = 0.3;
    const ChildEnd end = run_child(command, keep_);
    EXPECT_TRUE(end.overdue);
    EXPECT_FALSE(end.well());
    EXPECT_EQ(lines_, std::vector<std::string>{"here"});
}

TEST_F(ChildProcess, WhatItLeavesRunningIsNotWaitedFor) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(run_child(shell("sleep 1000 & exit 0"), keep_).well());
    EXPECT_LT(std::chrono::steady_clock::now() - start, 10s);
}

TEST_F(ChildProcess, OneThatIsNotThereIsASentence) {
    ChildCommand command;
    command.program = path("nothing here");
    EXPECT_THROW(run_child(command, keep_), Error);
}

TEST_F(ChildProcess, ALockKeepsASecondRunOut) {
    const FolderLock lock(path("lock"));
    EXPECT_THROW(FolderLock{path("lock")}, Error);
}

TEST_F(ChildProcess, ALockThatIsLetGoIsFree) {
    for (int i = 0; i < 3; i++)
        const FolderLock lock(path("lock"));
}

// What a program leaves behind outside of its group, or what takes a moment to die, has the lock's file open.
TEST_F(ChildProcess, ALockThatIsLetGoIsFreeWhateverStillHasItsFile) {
    {
        FolderLock lock(path("lock"));
        ChildCommand command =
            shell("exec >/dev/null 2>&1; setsid -f sh -c 'echo $$ >$PID_FILE; exec sleep 1000'; " +
                  std::string("while [ ! -s $PID_FILE ]; do sleep .01; done"));
        command.environment.emplace_back("PID_FILE", path("pid"));
        command.lock = &lock;
        EXPECT_TRUE(run_child(command, keep_).well());
    }
    EXPECT_NO_THROW(FolderLock{path("lock")});
    EXPECT_TRUE(lives(std::stoi(get("pid"))));
    ::kill(std::stoi(get("pid")), SIGKILL);
}

// Our process ends, as by kill -9, while its program works on.
TEST_F(ChildProcess, ALockOfAKilledRunIsTakenFromItsProgram) {
    const pid_t ours = ::fork();
    if (ours == 0) {
        FolderLock lock(path("lock"));
        ChildCommand command = shell("echo $$; exec sleep 1000 >/dev/null 2>&1");
        command.lock = &lock;
        run_child(command,
                  [&](const std::string& line) { std::ofstream(path("pid")) << line << std::flush; });
        ::_exit(0);
    }
    while (get("pid").empty())
        std::this_thread::sleep_for(10ms);
    std::this_thread::sleep_for(200ms);
    ::kill(ours, SIGKILL);
    ::waitpid(ours, nullptr, 0);
    EXPECT_TRUE(lives(std::stoi(get("pid"))));
    EXPECT_NO_THROW(FolderLock{path("lock")});
    std::ifstream stat("/proc/" + get("pid") + "/stat");
    std::string text;
    std::getline(stat, text);
    EXPECT_TRUE(text.empty() || text.find(") Z") != std::string::npos) << text;
}

TEST(ColmapLog, CountsAreRead) {
    const auto counted = [](const std::string& line) {
        const CountInLine count = count_in(line);
        return std::pair(count.done, count.all);
    };
    using Pair = std::pair<size_t, size_t>;
    EXPECT_EQ(counted("Processed file [12/71]"), Pair(12, 71));
    EXPECT_EQ(counted("Matching block [2/8, 3/8] in 1.234s"), Pair(11, 64));
    EXPECT_EQ(counted("I20250101 [a] Processing block [1/1, 1/1]"), Pair(1, 1));
    EXPECT_EQ(counted("nothing [here], 3/4"), Pair(0, 0));
    EXPECT_EQ(counted("[12/"), Pair(0, 0));
    EXPECT_EQ(counted("[1/2, 3"), Pair(0, 0));
    EXPECT_EQ(number_after("Registering image #5 (12)", "("), 12u);
    EXPECT_EQ(number_after("Registering image #5 (num_reg_frames=9)", "("), 9u);
    EXPECT_EQ(number_after("  Features:       2500", "Features:"), 2500u);
    EXPECT_EQ(number_after("  Features: none", "Features:"), 0u);
}

}  // namespace
}  // namespace treerec
