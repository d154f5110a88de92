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
    {"sympodial", R"(# Forks with one arm nearly straight on (after Aono and Kunii; ABOP, figure 2.7).
iterations: 10
r1 = 0.9
r2 = 0.7
a1 = 10
a2 = 60
wr = 0.707
axiom: A(1.2, 0.13)
A(l, w) -> !(w) F(l) [&(a1) B(l*r1, w*wr)] /(180) [&(a2) B(l*r2, w*wr)]
B(l, w) -> !(w) F(l) [+(a1) $ B(l*r1, w*wr)] [-(a2) $ B(l*r2, w*wr)]
)"},
    {"ternary",
     R"(# Three arms at every fork, bent by their weight; all wood grows at every step (ABOP, figure 2.8).
iterations: 6
d1 = 94.74
d2 = 132.63
a = 18.95
lr = 1.109    # what lengths
vr = 1.732    # and radii grow by
w0 = 0.005
tropism: 0, -1, 0, 0.14
axiom: !(w0) F(1.2) /(45) A
A -> !(w0*vr) F(0.3) [&(a) F(0.3) A] /(d1) [&(a) F(0.3) A] /(d2) [&(a) F(0.3) A]
F(l) -> F(l*lr)
!(w) -> !(w*vr)
)"},
    {"oak", R"(# A broad crown on a short trunk: branches wind, and fork into a strong and a weak arm.
iterations: 14
leaf_preset: oak
seed: 2
tropism: 0, 1, 0, 0.06    # towards the light
axiom: !(0.3) F(0.2) !(0.24) F(0.4) &(2) !(0.22) F(0.6) ^(4) !(0.21) F(0.6) T(6, 0.2)
T(n, w) : n > 0 -> [&(uniform(50, 75)) L(1.15, w*0.6, 7)] /(normal(137.5, 15))
    !(w) &(normal(0, 6)) F(uniform(0.35, 0.6)) T(n-1, w*0.88)
T(n, w) -> [&(20) L(1, w, 7)] /(180) [&(35) L(1, w*0.8, 6)]
L(l, w, k) : k > 0 -> !(w) &(normal(0, 10)) +(normal(0, 10)) F(l*0.5)
    !(w*0.9) &(normal(0, 10)) +(normal(0, 10)) F(l*0.5) /(uniform(50, 130))
    [&(uniform(10, 25)) L(l*0.86, w*0.72, k-1)]
    ^(uniform(30, 50)) L(l*0.75, w*0.52, k-1)
L(l, w, k) -> !(max(w*0.5, 0.003)) F(l*0.7)
)"},
    {"birch", R"(# A slim leader to the top; the lower branches have died.
iterations: 38
leaf_preset: birch
seed: 1
tropism: 0, 1, 0, 0.035
axiom: !(0.13) F(0.2) !(0.105) F(0.4) T(28)
T(n) : n > 0 -> !(0.0035*n + 0.002) &(normal(0, 1.2)) +(normal(0, 1.2)) F(0.36)
    B(n) /(normal(137.5, 20)) T(n-1)
T(n) -> !(0.003) F(0.25)
B(n) : n < 23 -> [&(uniform(45, 62)) A(0.45 + 0.125*n, 0.003 + 0.0011*n, 8)]
B(n) -> *
# A branch: twigs to both sides, shorter towards its tip.
A(l, w, k) : k > 0 -> !(w) &(normal(2, 4)) +(normal(0, 4)) F(l/9) /(180)
    [&(uniform(30, 45)) S(l*(0.1 + 0.05*k), w*0.6)] A(l, w*0.82, k-1)
A(l, w, k) -> !(0.002) F(l/9)
S(l, w) -> !(w) F(l/3) [+(uniform(25, 40)) !(0.002) F(l/4) F(l/4)]
    &(5) F(l/3) [-(uniform(25, 40)) !(0.002) F(l/4)] !(0.002) F(l/3)
)"},
    {"spruce", R"(# A straight leader with a whorl of flat, feathered branches for every year.
iterations: 30
leaf_preset: spruce
seed: 1
tropism: 0, 1, 0, 0.04
axiom: !(0.16) F(0.2) !(0.13) F(0.4) T(22)
T(n) : n > 0 -> !(0.0055*n + 0.003) F(0.2 + 0.014*n) /(uniform(0, 72)) W(n) /(normal(72, 8)) W(n)
    /(normal(72, 8)) W(n) /(normal(72, 8)) W(n) /(normal(72, 8)) W(n) T(n-1)
T(n) -> !(0.004) F(0.3) !(0.002) F(0.25)
W(n) -> [&(50 + 2.4*n + normal(0, 4)) $ H(uniform(0.9, 1.1)*(0.06 + 0.112*n), 0.004 + 0.0011*n, 6)]
H(l, w, k) : k > 0 -> !(w) +(normal(0, 3)) F(l/7) [+(uniform(45, 60)) S(l*0.075*k, w*0.45)]
    [-(uniform(45, 60)) S(l*0.075*k, w*0.45)] H(l, w*0.8, k-1)
H(l, w, k) -> !(0.002) F(l/7)
S(l, w) -> !(max(w, 0.002)) F(l/2) !(0.002) F(l/2)
)"},
    {"willow", R"(# Branches that rise and spread, and long shoots that hang from them.
iterations: 24
leaf_preset: willow
seed: 3
tropism: 0, -1, 0, 0.11   # a little at every F: most where there are many, in the shoots
axiom: !(0.27) F(0.2) !(0.22) F(0.7) &(3) !(0.2) F(0.8) X
X -> [&(22) L(1.6, 0.13, 3)] /(normal(72, 10)) [&(38) L(1.5, 0.11, 3)]
    /(normal(72, 10)) [&(30) L(1.6, 0.12, 3)] /(normal(72, 10)) [&(45) L(1.4, 0.1, 3)]
    /(normal(72, 10)) [&(35) L(1.5, 0.11, 3)]
L(l, w, k) : k > 0 -> !(w) ^(8) +(normal(0, 8)) F(l/2) [&(uniform(30, 60)) S(w*0.12, 10)]
    !(w*0.85) ^(8) F(l/2) /(uniform(60, 120)) [&(uniform(20, 35)) L(l*0.8, w*0.65, k-1)]
    [^(uniform(20, 40)) L(l*0.75, w*0.6, k-1)] /(90) [&(uniform(30, 60)) S(w*0.12, 11)]
L(l, w, k) -> [S(w*0.3, 12)] [&(uniform(30, 60)) S(w*0.3, 11)]
    /(120) [&(uniform(30, 60)) S(w*0.3, 12)] /(120) [&(uniform(30, 60)) S(w*0.3, 13)]
S(w, k) : k > 0 -> !(max(w, 0.002)) +(normal(0, 4)) &(normal(0, 4)) F(0.24) S(w*0.85, k-1)
S(w, k) -> *
)"},
    {"hazel", R"(# A shrub: rods from one stool, each with twigs to both sides.
iterations: 30
seed: 1
tropism: 0, 1, 0, 0.015
axiom: !(0.09) F(0.06) R(15)
R(n) : n > 0 -> [&(uniform(6, 42)) !(0.03) F(0.12) P(uniform(0.7, 1.1), uniform(0.014, 0.026), 9)]
    /(normal(137.5, 20)) R(n-1)
R(n) -> *
P(s, w, k) : k > 6 -> !(w) +(normal(0, 4)) &(normal(0, 4)) F(0.36*s) P(s, w*0.94, k-1)
P(s, w, k) : k > 0 -> !(w) +(normal(0, 5)) &(normal(0, 5)) F(0.34*s) /(normal(160, 20))
    [&(uniform(30, 50)) Q(s*(0.25 + 0.09*k), w*0.55, 4)] P(s, w*0.83, k-1)
P(s, w, k) -> !(0.0025) F(0.2*s)
Q(l, w, k) : k > 0 -> !(max(w, 0.002)) +(normal(0, 6)) F(l/4) /(180)
    [&(uniform(30, 50)) !(0.002) F(l*0.12*k)] Q(l, w*0.7, k-1)
Q(l, w, k) -> !(0.002) F(l/5)
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
