// The program itself, run as a user runs it. TREEREC_CLI names the program; without it these tests skip.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "cases.h"
#include "progress.h"

#ifndef _WIN32
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace treerec::test {

namespace fs = std::filesystem;

struct Outcome {
    int code = -1;
    std::string out;
    std::string error;
};

// Cancelled after a while.
class StopAfter : public Progress {
  public:
    explicit StopAfter(std::chrono::milliseconds time) : until_(std::chrono::steady_clock::now() + time) {}
    bool cancelled() const override { return std::chrono::steady_clock::now() > until_; }

  private:
    std::chrono::steady_clock::time_point until_;
};

// Each test gets a folder of its own, with an empty folder "out" in it.
class InFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("treerec_" + std::to_string(::getpid()) + "_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "out");
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string get(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::string put(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    fs::path folder_;
};

class Cli : public InFolder {
  protected:
    void SetUp() override {
        const char* program = std::getenv("TREEREC_CLI");
        if (!program || !fs::exists(program)) GTEST_SKIP() << "TREEREC_CLI does not name the program";
        program_ = fs::absolute(program).string();
        InFolder::SetUp();
    }

    // Runs "treerec <words>" in the test's folder.
    Outcome run(const std::string& words) const {
        const std::string command = "cd '" + folder_.string() + "' && timeout " +
                                    (kSanitized ? "900 '" : "120 '") + program_ + "' " + words +
                                    " >stdout.log 2>stderr.log </dev/null";
        const int status = std::system(command.c_str());
        Outcome outcome;
        outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000;
        outcome.out = get("stdout.log");
        outcome.error = get("stderr.log");
        return outcome;
    }

    bool out_is_empty() const { return fs::is_empty(folder_ / "out"); }

    std::string program_;
};

}  // namespace treerec::test
