#include "edit/commands/script.h"
#include "fuzz.h"

namespace {

treerec::Tree small_tree() {
    treerec::Tree tree;
    treerec::NodeId at = tree.add_root({0, 0, 0}, 0.1, treerec::kTrunkFlag);
    for (int i = 1; i < 6; i++)
        at = tree.add_child(at, {0.05 * i, 0.5 * i, 0}, 0.1 / i, treerec::kTrunkFlag);
    for (int i = 1; i < 6; i++)
        at = tree.add_child(i == 3 ? 2 : at, {0.3 * i, 2.0, 0.1 * i * i}, 0.02);
    return tree;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace treerec;
    const std::string_view script(reinterpret_cast<const char*>(data), size);
    // A few commands can make a large tree of a small one; that takes time, and is no fault.
    if (script.find("subdivide") != std::string_view::npos || script.find("graft") != std::string_view::npos)
        return 0;
    set_thread_count(1);
    const Tree start = small_tree();
    for (const bool keep_going : {false, true}) {
        Tree tree = start;
        try {
            const ScriptResult result = run_script(tree, script, {0.0, keep_going, nullptr});
            fuzz::require(tree.check() == std::nullopt, "the tree is sound");
            Tree back = tree;
            result.delta.revert(back);
            fuzz::require(identical(back, start), "undo leads back");
            // What was done does the same again.
            if (result.left_out.empty()) {
                Tree again = start;
                run_script(again, result.log.text());
                fuzz::require(identical(again, tree), "the log does the same");
            }
        } catch (const Error& error) {
            fuzz::require(identical(tree, start), "nothing changed");
        }
    }
    try {
        const EditLog log = EditLog::parse(script);
        fuzz::require(EditLog::parse(log.text()).text() == log.text(), "a log reads back");
    } catch (const Error&) {
    }
    return 0;
}
