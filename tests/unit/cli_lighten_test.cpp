#include "cli_runner.h"
#include "exchange/tree_files.h"
#include "random_tree.h"

namespace treerec {
namespace {

using test::Outcome;

class CliLighten : public test::Cli {
  protected:
    void SetUp() override {
        Cli::SetUp();
        if (IsSkipped()) return;
        write_treefile(path("a.txt"), test::random_tree(1, 2000));
    }
};

TEST_F(CliLighten, WritesFewerNodesAndTellsWhatItCost) {
    const Outcome share = run("lighten a.txt --share 0.25 -o out/b.txt -o out/b.glb --up y");
    ASSERT_EQ(share.code, 0) << share.error;
    EXPECT_EQ(read_treefile(path("out/b.txt")).size(), 500u);
    EXPECT_GT(test::fs::file_size(path("out/b.glb")), 10000u);
    EXPECT_NE(share.out.find("2000 nodes before, 500 after"), std::string::npos) << share.out;
    EXPECT_NE(share.out.find("of the outline"), std::string::npos) << share.out;
    ASSERT_EQ(run("lighten a.txt --nodes 30 -o out/c.txt --quiet").code, 0);
    EXPECT_EQ(read_treefile(path("out/c.txt")).size(), 30u);
    ASSERT_EQ(run("lighten a.txt --distance 0.5 --deviation 0.1 -o out/d.txt --quiet").code, 0);
    ASSERT_EQ(run("lighten a.txt --merge --angle 40 --distance 0.5 -o out/e.txt --quiet").code, 0);
    for (const char* file : {"out/d.txt", "out/e.txt"}) {
        EXPECT_LT(read_treefile(path(file)).size(), 1900u);
        EXPECT_GT(read_treefile(path(file)).size(), 100u);
    }
    // The same as a command of the editor's.
    ASSERT_EQ(run("edit a.txt -c 'lighten nodes=30' -o out/f.txt --quiet").code, 0);
    EXPECT_EQ(get("out/c.txt"), get("out/f.txt"));
    ASSERT_EQ(run("edit a.txt -c 'merge angle=40 distance=0.5' -o out/g.txt --quiet").code, 0);
    EXPECT_EQ(get("out/e.txt"), get("out/g.txt"));
}

TEST_F(CliLighten, WrongCommandLinesAreTold) {
    for (const char* words :
         {"a.txt", "-o out/b.txt", "a.txt a.txt -o out/b.txt", "a.txt -o out/b.txt --nodes 1",
          "a.txt -o out/b.txt --share 2", "a.txt -o out/b.txt --nodes 9 --share 0.5",
          "a.txt -o out/b.txt --merge --nodes 9", "a.txt -o out/b.txt --angle 200"})
        EXPECT_EQ(run("lighten " + std::string(words)).code, 2) << words;
    EXPECT_EQ(run("lighten a.txt -o out/b.blend").code, 1);
    EXPECT_EQ(run("lighten none.txt -o out/b.txt").code, 1);
    EXPECT_EQ(run("edit a.txt -c 'lighten nodes=9 share=0.5' -o out/b.txt").code, 1);
    EXPECT_TRUE(out_is_empty());
}

}  // namespace
}  // namespace treerec
