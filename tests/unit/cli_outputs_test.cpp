// What the program writes over, and what it never does.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cli_runner.h"
#include "file_bytes.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;

class CliOutputs : public Cli {
  protected:
    void SetUp() override {
        Cli::SetUp();
        if (IsSkipped()) return;
        ASSERT_EQ(run("synth -o s --seed 4 --height 4 --points 3000 --quiet").code, 0);
    }
};

// A shell makes "*.ply" all scans of a folder: the second was once taken for a file to write.
TEST_F(CliOutputs, ASecondWordIsNeverAFileToWrite) {
    put("mine.ply", get("s/scan.ply"));
    for (const std::string command :
         {"reconstruct s/scan.ply mine.ply -o out/a.glb", "reconstruct s/scan.ply -o out/a.glb mine.ply",
          "reconstruct -o out/a.glb s/scan.ply mine.ply", "reconstruct s/scan.ply mine.ply",
          "info s/scan.ply mine.ply", "edit s/truth.txt mine.ply -c 'scale node=0 factor=1.1' -o out/a.txt",
          "lighten s/truth.txt mine.ply -o out/a.txt", "lstring s/truth.txt mine.ply",
          "lstring s/truth.txt mine.ply -o out/a.lstring", "grow oak mine.ply -o out/a.glb",
          "score s/truth.txt s/scan.ply mine.ply", "synth mine.ply -o out", "textures mine.ply -o out"}) {
        const Outcome outcome = run(command);
        EXPECT_EQ(outcome.code, 2) << command << outcome.error;
        EXPECT_TRUE(out_is_empty()) << command;
        EXPECT_EQ(get("mine.ply"), get("s/scan.ply")) << command;
    }
}

// Names that stand behind no -o: a report, a page, a log, what a folder or a model gets beside it.
TEST_F(CliOutputs, NothingOfTheUsersIsWrittenOver) {
    const std::string mine = "what I have";
    const std::vector<std::pair<std::string, std::string>> cases = {
        {"mine.ply", "reconstruct s/scan.ply -o out/a.txt --report mine.ply"},
        {"mine.json", "reconstruct s/scan.ply -o out/a.txt --report mine.json"},
        {"mine.html", "reconstruct s/scan.ply -o out/a.txt --html mine.html"},
        {"mine.txt", "edit s/truth.txt -c 'scale node=0 factor=1.1' -o out/a.txt --log mine.txt"},
        {"out/scan.ply", "synth -o out --seed 1 --height 3 --points 500"},
        {"out/truth.txt", "synth -o out --seed 1 --height 3 --points 500"},
        {"out/maple_bark_albedo.jpg", "textures -o out --preset maple --size 16"},
        {"out/a.bin", "reconstruct s/scan.ply -o out/a.gltf"},
        {"out/a.mtl", "reconstruct s/scan.ply -o out/a.obj"},
        {"out/a_bark_albedo.jpg", "edit s/truth.txt -c 'scale node=0 factor=1.1' -o out/a.obj"},
    };
    for (const auto& [name, command] : cases) {
        put(name, mine);
        const Outcome outcome = run(command + " --quiet");
        EXPECT_NE(outcome.code, 0) << command;
        EXPECT_NE(outcome.error.find("left as it"), std::string::npos) << command << outcome.error;
        EXPECT_EQ(get(name), mine) << command;
        std::filesystem::remove(path(name));
        EXPECT_TRUE(out_is_empty()) << command;
    }
}

TEST_F(CliOutputs, WhatIsOursIsWrittenAgain) {
    for (const std::string command :
         {"reconstruct s/scan.ply -o out/a.gltf -o out/a.obj --report out/r.json --html out/p.html",
          "edit s/truth.txt -c 'scale node=0 factor=1.1' -o out/b.obj --log out/log.txt",
          "synth -o out/s --seed 1 --height 3 --points 500", "textures -o out/t --preset maple --size 16"})
        for (int time = 0; time < 2; time++) {
            const Outcome outcome = run(command + std::string(" --quiet"));
            EXPECT_EQ(outcome.code, 0) << command << outcome.error;
        }
    // A file without a byte is nobody's.
    put("out/empty.json", "");
    EXPECT_EQ(run("reconstruct s/scan.ply -o out/c.txt --report out/empty.json --quiet").code, 0);
}

// Each writer leaves one whole file: which one, nobody knows.
TEST(WritingAtOnce, LeavesAWholeFile) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("treerec_at_once_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::string path = utf8_of(folder / "tree.glb");
    constexpr int kWriters = 4;
    constexpr size_t kSize = size_t{3} << 20;
    for (int round = 0; round < 8; round++) {
        std::vector<std::thread> writers;
        for (int w = 0; w < kWriters; w++)
            writers.emplace_back([&, w] {
                // Of different lengths: a shorter one over a longer one shows.
                write_file(path,
                           std::string(kSize - static_cast<size_t>(w) * 4096, static_cast<char>('a' + w)));
            });
        for (std::thread& writer : writers)
            writer.join();
        const FileBytes bytes = read_file(path);
        const std::string_view view = bytes.view();
        const char first = view[0];
        EXPECT_EQ(view.size(), kSize - static_cast<size_t>(first - 'a') * 4096);
        EXPECT_EQ(view.find_first_not_of(first), std::string_view::npos);
        EXPECT_EQ(
            std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()),
            1);
    }
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace treerec
