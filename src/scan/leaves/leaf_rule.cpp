#include "scan/leaves/leaf_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/parallel.h"
#include "geometry/point_tree.h"
#include "geometry/portable_math.h"

namespace treerec {

namespace {

constexpr size_t kGrain = 1024;
constexpr std::array<size_t, 2> kNearest{8, 24};  // points
constexpr size_t kLookedAt = 2;                   // points of a cell, at most
constexpr int kWayBack = 4;                       // steps to the ground that give a cell's direction
constexpr size_t kLeafInputs = kCellInputs + kNearest.size() * kNearInputs;
constexpr float kReach = 3.0F;       // standard deviations: what lies further out says no more
constexpr double kLeafyTree = 1.25;  // half way between the leafiest bare tree and the barest leafy one

// Both were fitted to virtual scans of all habits but the palm, with and without noise and shadows, some with
// their leaves thickened to dense foliage; to a split tree, bare ones and dense real crowns.
struct Term {
    float mean;
    float deviation;
    float weight;  // of the standardised value; the sum is a logit
};
constexpr std::array<Term, kCellInputs> kTreeTerms{{
    {0.3253F, 0.1126F, -0.2589F}, {0.3098F, 0.1074F, -0.03627F}, {0.3628F, 0.1691F, 0.2015F},
    {0.448F, 0.138F, 0.0107F},    {2.434F, 0.2716F, 0.09058F},   {0.3292F, 0.0988F, -0.287F},
    {0.2771F, 0.09153F, 0.3848F}, {0.3929F, 0.1412F, -0.05276F}, {0.5065F, 0.1519F, 0.07377F},
    {3.05F, 0.4639F, 0.05652F},   {0.3205F, 0.07541F, -0.5299F}, {0.2418F, 0.05288F, 0.8752F},
    {0.437F, 0.1081F, -0.06601F}, {0.557F, 0.1361F, 0.04562F},   {3.652F, 0.5818F, 0.07099F},
    {0.5056F, 0.09426F, 0.3039F}, {0.6303F, 0.1198F, -0.1075F},  {4.334F, 0.6787F, 0.09426F},
    {1.548F, 0.3126F, -0.7314F},  {2.119F, 0.3295F, -0.9717F},   {2.066F, 0.3643F, -0.8432F},
    {0.844F, 0.06719F, -0.541F},  {0.8474F, 0.02639F, -0.5291F}, {0.79F, 0.04808F, 0.2612F},
    {0.9566F, 0.1374F, 0.2384F},  {0.7782F, 0.1804F, 0.4087F},   {1.128F, 0.2992F, 0.4945F},
    {1.553F, 0.4705F, 0.4712F},
}};
constexpr double kTreeBias = 2.98;

constexpr std::array<float, kLeafInputs> kMeans{
    0.2856F, 0.2957F, 0.4179F,  0.4909F, 2.531F,  0.2893F, 0.2609F, 0.4498F, 0.5648F, 3.225F,
    0.291F,  0.2286F, 0.4804F,  0.6163F, 3.897F,  0.5303F, 0.6677F, 4.625F,  1.386F,  1.957F,
    1.889F,  0.8437F, 0.8351F,  0.7719F, 0.9343F, 0.8737F, 1.275F,  1.787F,  0.3337F, 0.3386F,
    0.3277F, 0.4224F, -0.2982F, 0.3076F, 0.2784F, 0.2963F, 0.4253F, 0.4592F, 0.2858F, 0.2737F};
constexpr std::array<float, kLeafInputs> kDeviations{
    0.1941F, 0.2002F, 0.227F,  0.2154F, 0.4476F, 0.1844F, 0.1739F, 0.2032F, 0.2212F, 0.6358F,
    0.1792F, 0.1512F, 0.1894F, 0.2279F, 0.787F,  0.1855F, 0.239F,  0.9103F, 1.328F,  2.06F,
    1.426F,  0.9682F, 0.0816F, 0.113F,  0.7726F, 0.5829F, 0.7261F, 0.9233F, 0.1602F, 0.1844F,
    0.1692F, 0.1774F, 0.3541F, 0.1326F, 0.167F,  0.1987F, 0.1916F, 0.1574F, 0.3534F, 0.1317F};
constexpr size_t kHidden = 12;
constexpr std::array<std::array<float, kHidden>, kLeafInputs> kFirst{{
    {-0.01507F, -0.1372F, -0.3288F, -0.09224F, -0.09498F, -0.154F, 0.1228F, 0.2217F, 0.4658F, 0.09676F,
     -0.02449F, 0.2222F},
    {0.1393F, 0.4082F, -0.2747F, -0.1083F, -0.4584F, -0.1037F, 0.2583F, 0.3849F, 0.3895F, 0.1371F, -0.2054F,
     0.5625F},
    {-0.1581F, -0.1903F, -0.1071F, -0.03587F, 0.1719F, 0.1744F, -0.4542F, 0.2284F, -0.3806F, -0.08942F,
     0.4532F, -0.4947F},
    {0.36F, -0.5666F, 0.143F, -0.3604F, 0.04529F, 0.1473F, -0.09511F, -0.5368F, 0.01302F, 0.2795F, -0.7955F,
     0.1301F},
    {-0.2157F, 0.3313F, -0.00493F, 0.3185F, -0.2933F, -0.6831F, 0.3767F, 0.3898F, 0.3575F, -0.6168F,
     0.008265F, 0.147F},
    {-0.1589F, -0.2713F, -0.02F, -0.1119F, 0.1596F, -0.1248F, -0.01135F, 0.007723F, 0.0935F, -0.183F,
     -0.03222F, -0.2836F},
    {-0.03392F, -0.2601F, 0.176F, -0.1805F, -0.3299F, -0.1856F, 0.3421F, 0.2234F, 0.03842F, 0.1863F, -0.1359F,
     0.5354F},
    {0.3207F, 0.266F, 0.05445F, -0.3826F, -0.1367F, 0.2935F, -0.1985F, -0.5311F, -0.1954F, -0.06421F, 0.1265F,
     -0.5454F},
    {0.2367F, -0.7182F, -0.547F, -0.3666F, 0.03785F, 0.1979F, -0.1131F, -0.2534F, -0.1163F, -0.1405F,
     -0.07958F, 0.2487F},
    {-0.4286F, 1.577F, 1.106F, 0.4456F, 0.07269F, 0.3128F, 0.1234F, 0.5016F, 0.5704F, -0.5145F, 0.3975F,
     0.4835F},
    {0.03097F, 0.1886F, 0.02059F, 0.3396F, 0.02859F, 0.3909F, -0.0006669F, 0.0359F, 0.4856F, 0.04647F,
     0.1041F, -0.1263F},
    {-0.08646F, -0.01046F, 0.2463F, 0.2267F, 0.1655F, 0.08019F, -0.1219F, 0.003269F, 0.1155F, -0.09734F,
     -0.09396F, 0.15F},
    {0.1915F, 0.1942F, -0.232F, 0.2406F, 0.01379F, 0.2158F, 0.1988F, -0.08412F, -0.03143F, 0.08499F, -0.3121F,
     -0.4898F},
    {0.09961F, -0.5896F, -0.2787F, -0.1326F, 0.1909F, -0.2317F, -0.2125F, 0.02154F, -0.345F, -0.03719F,
     0.09729F, 0.1268F},
    {-0.1785F, 0.2208F, 0.8069F, -0.06971F, -0.1699F, 0.05615F, 1.124F, -0.3892F, 0.733F, 0.3212F, 0.04354F,
     0.3142F},
    {0.1812F, 0.1527F, -0.0401F, -0.2703F, 0.5417F, -0.3722F, -0.07011F, -0.07006F, -0.5842F, -0.3702F,
     -0.6051F, -0.3538F},
    {-0.6266F, 0.174F, -0.05059F, 0.5861F, -0.536F, 0.07458F, -1.369F, 0.3867F, -0.2808F, -0.2198F, 0.08991F,
     -0.1112F},
    {0.9155F, -0.9711F, 0.5572F, 0.0645F, 0.9228F, 0.2853F, 0.8162F, -0.01231F, 0.3771F, -0.5315F, -1.094F,
     0.8544F},
    {-0.2942F, -0.4052F, -0.1012F, -0.7801F, -0.1227F, -0.06823F, -0.2593F, -0.01507F, -0.9716F, -0.05251F,
     0.8228F, -0.07365F},
    {0.2645F, 0.4395F, -0.1888F, 0.5218F, 0.9252F, 0.3506F, 0.1101F, 0.08203F, 0.549F, 1.475F, -0.4233F,
     -0.4901F},
    {0.3694F, 0.3756F, 0.2606F, 0.3408F, -0.2781F, 0.0583F, 0.2814F, -0.2083F, 0.07292F, -0.2989F, -0.3485F,
     0.1523F},
    {-0.2576F, -0.3209F, 0.01083F, -0.3386F, -0.2932F, -0.01945F, -0.2932F, -0.2616F, -0.4572F, 0.08748F,
     0.03688F, 0.1868F},
    {-0.003695F, -0.008888F, 0.2151F, -0.009086F, 0.4525F, -0.1627F, -0.09584F, -0.0238F, 0.2606F, 0.2139F,
     -0.1532F, 0.1412F},
    {-0.2847F, 0.05057F, -0.297F, 1.475F, -0.09436F, 0.4011F, 0.07061F, 0.1135F, -0.2626F, -0.3414F, 0.01902F,
     -0.2455F},
    {-0.5211F, 0.1194F, -0.07958F, -1.731F, 0.2129F, 0.3433F, 0.4175F, 0.02809F, -0.1259F, -2.043F, -0.3939F,
     0.2723F},
    {0.06421F, 0.01028F, -0.2048F, 0.01748F, -0.1555F, -0.12F, -0.0006278F, 0.3514F, -0.2487F, 0.2262F,
     0.04861F, -0.03302F},
    {-0.185F, 0.02577F, -0.07256F, -0.1664F, -0.2087F, 0.02367F, -0.1013F, 0.7474F, -0.171F, 0.1529F, 0.1117F,
     -0.1528F},
    {0.1576F, -0.2559F, 0.4391F, -0.479F, 0.05625F, 0.3175F, -0.1028F, 1.067F, -0.6041F, 0.4124F, 0.1938F,
     0.2645F},
    {-0.09848F, 0.09119F, 0.0763F, -0.2667F, 0.1564F, 0.2284F, 0.01365F, -0.1428F, -0.1266F, -0.251F,
     0.09278F, -0.04089F},
    {-0.1284F, 0.2311F, -0.05647F, -0.1291F, 0.1076F, -0.4879F, 0.119F, -0.02473F, 0.101F, -0.2467F, 0.125F,
     0.1307F},
    {0.2716F, 0.0587F, 0.1311F, -0.1354F, -0.3064F, -0.1753F, -0.007977F, 0.06971F, 0.1585F, -0.08833F,
     0.007352F, 0.04691F},
    {0.2885F, -0.0154F, -0.2313F, 0.1805F, 0.3384F, 0.2683F, -0.08072F, -0.02212F, 0.07079F, 0.3228F,
     -0.2243F, 0.1739F},
    {0.8656F, 0.7725F, 0.9048F, 0.08876F, -0.1214F, -1.187F, -0.1772F, -0.5313F, -0.02557F, 0.3202F, -0.9055F,
     -0.05261F},
    {0.05934F, -0.2115F, -0.2252F, -0.0726F, -0.2472F, -0.2524F, -0.05439F, 0.03663F, 0.0758F, 0.02079F,
     -0.05928F, -0.09703F},
    {0.06903F, -0.01318F, -0.3812F, -0.2145F, -0.03731F, 0.4608F, 0.09358F, -0.1474F, 0.03638F, -0.01319F,
     0.075F, -0.2412F},
    {0.02353F, 0.3522F, 0.0288F, -0.05503F, 0.1158F, -0.2833F, 0.3653F, 0.02691F, 0.2518F, -0.1768F, -0.3915F,
     0.5554F},
    {0.05151F, -0.1479F, -0.03675F, -0.08286F, -0.1853F, -0.4858F, 0.01657F, -0.3889F, -0.4377F, 0.1286F,
     0.2661F, -0.593F},
    {-0.1302F, -0.123F, -0.2682F, 0.2156F, 0.26F, 0.1942F, -0.1024F, 0.2832F, 0.4983F, -0.2315F, 0.04191F,
     -0.02705F},
    {0.4698F, -0.5172F, -0.2325F, -0.2267F, -0.8822F, 0.672F, -0.3544F, 0.5222F, -0.4392F, 0.28F, 0.5644F,
     -0.3035F},
    {-0.384F, 0.08016F, 0.4221F, 0.07947F, 0.1377F, -0.00433F, 0.1328F, 0.9351F, -0.1945F, 0.03713F, 0.5943F,
     -0.4525F},
}};
constexpr std::array<float, kHidden> kFirstBias{-0.6142F, -0.5128F, -1.152F,  -1.218F,  -0.6724F, -0.5009F,
                                                -1.352F,  0.7964F,  -0.7223F, -0.1028F, 1.634F,   -1.427F};
constexpr std::array<float, kHidden> kSecond{0.5685F, -0.7562F, 0.6694F,  -1.244F,  -0.4589F, -0.4936F,
                                             -1.535F, 0.2865F,  -0.7866F, -0.5485F, 0.5419F,  0.9118F};
constexpr float kSecondBias = 0.04955F;

float logit_of(const std::array<float, kLeafInputs>& inputs) {
    std::array<float, kHidden> hidden = kFirstBias;
    for (size_t i = 0; i < kLeafInputs; i++) {
        const float value = std::clamp((inputs[i] - kMeans[i]) / kDeviations[i], -kReach, kReach);
        for (size_t h = 0; h < kHidden; h++)
            hidden[h] += value * kFirst[i][h];
    }
    float logit = kSecondBias;
    for (size_t h = 0; h < kHidden; h++)
        logit += std::max(hidden[h], 0.0F) * kSecond[h];
    return logit;
}

}  // namespace

Vec3 heading_of(uint32_t cell, const Cells& cells, const CellPaths& paths) {
    uint32_t from = cell;
    for (int k = 0; k < kWayBack; k++)
        from = paths.parent[from];
    const Vec3 way = cells.centres[cell] - cells.centres[from];
    const float length = glm::length(way);
    return length > 0.0F ? way / length : Vec3(0.0F, 1.0F, 0.0F);
}

void measure_near(const std::vector<Vec3>& points, const Vec3& p, const uint32_t* nearest, size_t count,
                  float reach, float cell, const Vec3& heading, float* inputs) {
    const float share = 1.0F / static_cast<float>(count);
    Vec3 mean(0.0F);
    for (size_t i = 0; i < count; i++)
        mean += share * (points[nearest[i]] - p);
    std::array<float, 6> c{};
    for (size_t i = 0; i < count; i++)
        add_product(c, points[nearest[i]] - p - mean, share);
    const Vec3 s = deviations(c);
    const float first = std::max(s.x, 1e-9F);
    const float along =
        c[0] * heading.x * heading.x + c[3] * heading.y * heading.y + c[5] * heading.z * heading.z +
        2.0F * (c[1] * heading.x * heading.y + c[2] * heading.x * heading.z + c[4] * heading.y * heading.z);
    inputs[0] = (s.x - s.y) / first;
    inputs[1] = (s.y - s.z) / first;
    inputs[2] = s.z / first;
    inputs[3] = along / (c[0] + c[3] + c[5] + 1e-12F);
    inputs[4] = portable::log(reach / cell + 1e-3F);
    inputs[5] = glm::length(mean) / (reach + 1e-9F);
}

CellInputs inputs_of(const CellShape* shapes, const CellPath& path) {
    CellInputs inputs{};
    size_t at = 0;
    for (int s = 0; s < kShapeScales; s++) {
        if (s + 1 < kShapeScales) {
            inputs[at++] = shapes[s].linearity;
            inputs[at++] = shapes[s].planarity;
        }
        inputs[at++] = shapes[s].scatter;
        inputs[at++] = shapes[s].occupied / 26.0F;
        inputs[at++] = shapes[s].crowd;
    }
    for (const float value : {path.height, path.mass, path.chain, path.chain_mass, path.straight_short,
                              path.straight_long, path.gap, path.bush_8, path.bush_16, path.bush_32})
        inputs[at++] = value;
    return inputs;
}

double leafiness(const CellInputs& means) {
    double sum = kTreeBias - kLeafyTree;
    for (size_t i = 0; i < kCellInputs; i++) {
        const Term& term = kTreeTerms[i];
        sum += term.weight * std::clamp((means[i] - term.mean) / term.deviation, -kReach, kReach);
    }
    return sum;
}

std::vector<float> leaf_logits(const std::vector<Vec3>& points, const Cells& cells, const CellPaths& paths,
                               const std::vector<CellInputs>& inputs, const LeafLooks& looks,
                               const Progress& progress) {
    const PointTree tree(points);
    std::vector<std::array<uint32_t, kLookedAt>> looked_at(cells.count());
    std::vector<uint8_t> number(cells.count(), 0);
    for (uint32_t i = 0; i < points.size(); i++) {
        const uint32_t cell = cells.of_point[i];
        if (number[cell] < looks.points) looked_at[cell][number[cell]++] = i;
    }
    std::vector<float> logits(cells.count(), 0.0F);
    parallel_for(cells.count(), kGrain, [&](size_t begin, size_t end) {
        progress.check();
        std::array<uint32_t, kNearest.back()> nearest{};
        std::array<float, kNearest.back()> squared{};
        std::array<float, kLeafInputs> all{};
        for (size_t v = begin; v < end; v++) {
            if (v % looks.step != 0) {
                logits[v] = std::numeric_limits<float>::quiet_NaN();
                continue;
            }
            std::copy(inputs[v].begin(), inputs[v].end(), all.begin());
            const Vec3 heading = heading_of(static_cast<uint32_t>(v), cells, paths);
            for (size_t n = 0; n < number[v]; n++) {
                const Vec3& p = points[looked_at[v][n]];
                const size_t found = tree.nearest(p, nearest.size(), nearest.data(), squared.data());
                for (size_t k = 0; k < kNearest.size(); k++) {
                    const size_t count = std::min(kNearest[k], found);
                    measure_near(points, p, nearest.data(), count, std::sqrt(squared[count - 1]),
                                 static_cast<float>(cells.size), heading,
                                 &all[kCellInputs + k * kNearInputs]);
                }
                logits[v] += logit_of(all) / static_cast<float>(number[v]);
            }
        }
    });
    return logits;
}

}  // namespace treerec
