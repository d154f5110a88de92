// 'treerec edit', run as a user runs it.
#include "cli_runner.h"
#include "exchange/tree_files.h"
#include "random_tree.h"

namespace treerec {
namespace {

using test::Cli;
using test::Outcome;

class CliEdit : public Cli {
  protected:
    void SetUp() override {
        Cli::SetUp();
        if (IsSkipped()) return;
        Tree tree = test::random_tree(4, 400);
        tree.set_frame({{512034.25, 5409231.5, 88.25}, 1.0, UpAxis::kZ});
        write_treefile(path("tree.txt"), tree);
        nodes_ = tree.size();
    }
    size_t nodes_ = 0;
};

TEST_F(CliEdit, RunsScriptsAndCommandsAndWritesALog) {
    put("garden.txt", "# twigs first\nprune factor=1.2\n\nprune_order order=3\n");
    const Outcome done =
        run("edit tree.txt --script garden.txt -c 'sag weight=0.5' -o out/tree.txt -o out/tree.glb --log "
            "log.txt");
    ASSERT_EQ(done.code, 0) << done.error;
    EXPECT_NE(done.out.find("3 commands done, 0 left out; " + std::to_string(nodes_) + " nodes before, "),
              std::string::npos)
        << done.out;
    EXPECT_EQ(done.error, "Editing\n");
    EXPECT_LT(read_treefile(path("out/tree.txt")).size(), nodes_);
    EXPECT_GT(get("out/tree.glb").size(), 10000U);
    EXPECT_EQ(get("log.txt"),
              "# treerec edit log 1\nframe origin=512034.25,5409231.5,88.25 unit=1 up=z\nprune factor=1.2\n"
              "prune_order order=3\nsag weight=0.5\n");
    ASSERT_EQ(run("edit tree.txt --script log.txt -o out/again.txt --quiet").code, 0);
    EXPECT_EQ(get("out/again.txt"), get("out/tree.txt"));
}

TEST_F(CliEdit, TellsWhatIsWrongAndWritesNothing) {
    put("bad.txt", "prune\ncut node=99999\n");
    Outcome done = run("edit tree.txt --script bad.txt -o out/tree.txt");
    EXPECT_EQ(done.code, 1);
    EXPECT_EQ(done.error, "Editing\n'bad.txt': Line 2, column 1: There is no node 99999 in this tree.\n");
    EXPECT_TRUE(out_is_empty());
    done = run("edit tree.txt --script bad.txt -o out/tree.txt --keep-going");
    EXPECT_EQ(done.code, 0);
    EXPECT_NE(done.error.find("Left out: 'bad.txt': line 2: cut node=99999: There is no node"),
              std::string::npos)
        << done.error;
    EXPECT_NE(done.out.find("1 command done, 1 left out"), std::string::npos) << done.out;
    EXPECT_EQ(run("edit tree.txt -o out/tree2.txt").code, 2);
    EXPECT_EQ(run("edit tree.txt -c prune -o out/tree2.txt --leaves plastic").code, 2);
    EXPECT_EQ(run("edit tree.txt -c prune").code, 2);
    EXPECT_EQ(run("edit -c prune -o out/tree2.txt").code, 2);
    EXPECT_EQ(run("edit tree.txt -c prune -o out/tree.stl").code, 1);
    EXPECT_EQ(run("edit missing.txt -c prune -o out/tree2.txt").code, 1);
    EXPECT_EQ(run("edit tree.txt --script missing.txt -o out/tree2.txt").code, 1);
}

TEST_F(CliEdit, ListsEveryCommand) {
    const Outcome done = run("edit --commands");
    EXPECT_EQ(done.code, 0);
    for (const char* name : {"prune", "cut", "move", "sag", "graft", "keep_only"})
        EXPECT_NE(("\n" + done.out).find("\n" + std::string(name) + "  "), std::string::npos) << name;
}

}  // namespace
}  // namespace treerec
