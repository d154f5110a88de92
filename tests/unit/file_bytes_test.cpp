// Files written whole or not at all, and their names.
#include "file_bytes.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "error.h"
#include "scan_samples.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using scan_test::Folder;

std::string text_of(const std::string& path) {
    return std::string(read_file(path).view());
}

TEST(FileBytes, WritesAndLeavesNothingElse) {
    const Folder folder;
    const std::string path = folder.file("b\xC3\xA4um.txt");
    write_file(path, "one");
    write_file(path, "two");
    EXPECT_EQ(text_of(path), "two");
    const fs::path inside = path_of(path).parent_path();
    EXPECT_EQ(std::distance(fs::directory_iterator(inside), fs::directory_iterator()), 1);
}

TEST(FileBytes, ALinkStaysALink) {
    const Folder folder;
    write_file(folder.file("real.txt"), "old");
    fs::create_symlink("real.txt", path_of(folder.file("link.txt")));
    write_file(folder.file("link.txt"), "new");
    EXPECT_TRUE(fs::is_symlink(path_of(folder.file("link.txt"))));
    EXPECT_EQ(text_of(folder.file("real.txt")), "new");
}

TEST(FileBytes, ADeviceIsWrittenToAndNotReplaced) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    const Folder folder;
    fs::create_symlink("/dev/null", path_of(folder.file("null.txt")));
    fs::create_symlink("/dev/full", path_of(folder.file("full.txt")));
    EXPECT_NO_THROW(write_file(folder.file("null.txt"), "gone"));
    EXPECT_THROW(write_file(folder.file("full.txt"), "no room"), Error);
    EXPECT_TRUE(fs::is_character_file(path_of(folder.file("null.txt"))));
    EXPECT_TRUE(fs::is_character_file(path_of(folder.file("full.txt"))));
}

TEST(FileBytes, WhatCannotBeWrittenIsKnownBefore) {
    const Folder folder;
    EXPECT_NO_THROW(require_writable(folder.file("new.txt")));
    EXPECT_FALSE(fs::exists(path_of(folder.file("new.txt"))));
    EXPECT_FALSE(fs::exists(path_of(folder.file("new.txt.part"))));
    for (const std::string& bad :
         {std::string(), folder.file("."), folder.file("missing/new.txt"), folder.file(std::string(300, 'a')),
          std::string(5000, 'a'), std::string("a\0b", 3)}) {
        EXPECT_THROW(require_writable(bad), Error) << bad.substr(0, 40);
        EXPECT_THROW(write_file(bad, "text"), Error) << bad.substr(0, 40);
        EXPECT_THROW(read_file(bad), Error) << bad.substr(0, 40);
    }
}

TEST(FileBytes, Names) {
    EXPECT_EQ(extension_of("a/b.c/oak.PLY"), "ply");
    EXPECT_EQ(extension_of("a/b.c/oak"), "");
    EXPECT_EQ(stem_of("a/b.c/oak.tar.gz"), "oak.tar");
    EXPECT_EQ(sibling_of("a/oak.obj", "oak.mtl"), "a/oak.mtl");
    EXPECT_EQ(sibling_of("oak.obj", "oak.mtl"), "oak.mtl");
}

}  // namespace
}  // namespace treerec
