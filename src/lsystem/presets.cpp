#include "error.h"
#include "lsystem/grammar.h"

namespace treerec {

namespace {

struct Preset {
    const char* name;
    const char* text;
};

const Preset kPresets[] = {
    {"monopodial", R"(# A leader with side branches (after Honda; ABOP, figure 2.6).
iterations: 10
r1 = 0.9      # the trunk's and
r2 = 0.6      # a branch's length to the one below
a0 = 45       # between trunk and branch
a2 = 45       # between branch and twig
d = 137.5     # from one branch to the next
wr = 0.707    # radius to the one below
axiom: A(1, 0.1)
A(l, w) -> !(w) F(l) [&(a0) B(l*r2, w*wr)] /(d) A(l*r1, w*wr)
B(l, w) -> !(w) F(l) [-(a2) $ C(l*r2, w*wr)] C(l*r1, w*wr)
C(l, w) -> !(w) F(l) [+(a2) $ B(l*r2, w*wr)] B(l*r1, w*wr)
)"},
};

}  // namespace

std::string grammar_preset(std::string_view name) {
    for (const Preset& preset : kPresets)
        if (name == preset.name) return preset.text;
    std::string names;
    for (const std::string& known : grammar_preset_names())
        names += (names.empty() ? "" : ", ") + known;
    throw Error("There is no grammar " + quote_word(name) + "; there are " + names + ".");
}

std::vector<std::string> grammar_preset_names() {
    std::vector<std::string> names;
    for (const Preset& preset : kPresets)
        names.push_back(preset.name);
    return names;
}

}  // namespace treerec
