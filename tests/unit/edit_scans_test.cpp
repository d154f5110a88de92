// Edits on trees that were reconstructed from real scans.
#include <gtest/gtest.h>

#include <cstdlib>

#include "cases.h"
#include "edit/commands/script.h"
#include "edit_at_random.h"
#include "pipeline/reconstruct.h"

namespace treerec {
namespace {

using test::cases;
using test::edit_at_random;
using test::Tally;

class EditScans : public testing::Test {
  protected:
    void SetUp() override {
        const char* folder = std::getenv("TREEREC_SCANS");
        if (!folder) GTEST_SKIP() << "TREEREC_SCANS does not name the folder of the real scans.";
        folder_ = folder;
    }
    Tree tree_of(const std::string& file, const ReconstructOptions& options = {}) const {
        return reconstruct_file(folder_ + "/clouds/" + file, options).tree;
    }
    std::string folder_;
};

TEST_F(EditScans, TenThousandRandomEditsKeepTheTreesSoundAndUndo) {
    Tally tally;
    uint64_t seed = 1;
    struct Share {
        const char* file;
        int edits;
    };
    for (const Share& share : {Share{"vezy_A1B2.asc", 3000}, Share{"rtwig_coffeetree.txt", 3000},
                               Share{"vezy_A6B10.asc", 3500}, Share{"adtree_tree7.xyz", 500}}) {
        edit_at_random(tree_of(share.file), seed++, cases(share.edits), tally);
        if (HasFatalFailure()) FAIL() << share.file;
    }
    for (const EditCommand& command : edit_commands())
        EXPECT_GT(tally[command.name], cases(20)) << command.name << " hardly ever did anything";
}

// The work on one reconstruction is done again on another one of the same scan, made with other options:
// other ids, other nodes, in centimetres, with another axis up.
TEST_F(EditScans, ALogFitsTheTreeReconstructedAnew) {
    for (const char* file : {"vezy_A3B4.asc", "wytham_Tf18_birch.txt"}) {
        ReconstructOptions options;
        options.orient.up = UpAxis::kZ;
        options.orient.metres_per_unit = 1.0;
        Tree tree = tree_of(file, options);
        options.skeleton.seed = 7;
        options.skeleton.spacing = 0.015;
        options.orient.metres_per_unit = 0.5;
        Tree anew = tree_of(file, options);
        const Tree start = tree;
        ASSERT_FALSE(identical(start, anew));

        // Stout wood, so that both reconstructions have it.
        Random random(5);
        EditLog log;
        std::vector<NodeId> stout;
        for (const NodeId id : tree.depth_first())
            if (id != tree.root() && tree.node(id).radius > 0.01 && tree.node(id).depth > 5)
                stout.push_back(id);
        for (int i = 0; i < 20; i++) {
            const NodeId id = stout[random.below(static_cast<uint32_t>(stout.size()))];
            if (!tree.contains(id)) continue;
            const std::string name = std::to_string(id);
            const std::string line = i % 4 == 0   ? "cut node=" + name
                                     : i % 4 == 1 ? "turn node=" + name + " axis=0,1,0 angle=20"
                                     : i % 4 == 2 ? "thicken nodes=below:" + name + " factor=1.2"
                                                  : "prune_below node=" + name;
            log.add(perform(tree, line));
        }
        ScriptOptions replay;
        replay.keep_going = true;
        const ScriptResult result = run_script(anew, log.text(), replay);
        // What was turned before may have taken wood elsewhere than on the first tree, by the difference.
        EXPECT_GE(result.done, log.entries().size() * 3 / 4) << file << "\n" << result.log.text();
        EXPECT_EQ(result.done + result.left_out.size(), log.entries().size());
        EXPECT_EQ(anew.check(), std::nullopt);
        const auto height = [](const Tree& t) { return t.frame().length_to_scan(t.bounds().size().y); };
        EXPECT_NEAR(height(anew), height(tree), 0.05 * height(start)) << file;
    }
}

}  // namespace
}  // namespace treerec
