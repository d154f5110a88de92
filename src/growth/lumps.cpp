#include "growth/lumps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "edit/commands/command_text.h"
#include "error.h"
#include "geometry/quantile.h"
#include "growth/bark_map.h"
#include "growth/lump_fit.h"
#include "growth/section.h"
#include "growth/section_fit.h"
#include "growth/twist_fit.h"
#include "tree/wood_segments.h"

namespace treerec {

namespace {

using namespace growth;

constexpr double kFinest = 0.6;  // longest edges: the cells' size, of a scan that is dense enough
constexpr double kApart = 1.5;   // of the points' distance from one another, that cells have
constexpr double kFewestColumns = 8.0, kMostColumns = 128.0;
constexpr double kBeside = 1.6;     // radii of a branch about it in which its parent's bark is not seen well,
constexpr double kNear = 1.5;       // where it is not farther from that bark than so many of the parent's
constexpr double kLeastWood = 1.5;  // longest edges: the radius of wood whose lumps can be shown
constexpr double kHollowFrom = 0.75, kHollowUntil = 0.95;
constexpr double kTolerance = 0.03;  // shares of the radius: what sections may leave out
constexpr double kLeastPace = 0.1;
constexpr double kMostGrowth = 20.0;  // that a recipe takes

// What lies below other wood is hidden by it, or its own: not known.
void leave_out_forks(const Tree& tree, const BranchList& list, const TreePlan& planned, const BarkAxes& axes,
                     int32_t branch, BarkMap& map) {
    const int32_t listed = planned.branch_of[static_cast<size_t>(branch)];
    const double columns = static_cast<double>(map.columns);
    const auto leave_out = [&](const DVec3& p, double thick, const AxisPlace& axis) {
        const double around = axes.coordinates(branch).around(p, axis.along);
        const double beside = kBeside * thick + map.step;
        for (size_t row = 0; row < map.rows; row++) {
            const double up = map.along(row) - axis.along;
            if (std::abs(up) > beside) continue;
            for (size_t column = 0; column < map.columns; column++) {
                const double across =
                    std::remainder((static_cast<double>(column) + 0.5) / columns - around, 1.0) * columns *
                    map.width(row);
                if (up * up + across * across < beside * beside)
                    map.height[map.cell(row, column)] = std::numeric_limits<double>::quiet_NaN();
            }
        }
    };
    for (const WoodSegment& wood : wood_segments(tree)) {
        const int32_t of = list.branch_of[static_cast<size_t>(wood.child)];
        if (of == listed) continue;
        const double length = glm::distance(wood.from, wood.to);
        const auto near = [&](const DVec3& p, double more, AxisPlace& axis) {
            const auto [place, out] = axes.nearest(branch, p);
            axis = place;
            return out < (1.0 + kNear) * place.radius + wood.radius + more;
        };
        AxisPlace axis;
        if (!near(0.5 * (wood.from + wood.to), 0.5 * length, axis)) continue;
        const int parts = static_cast<int>(std::ceil(length / std::max(map.step, wood.radius)));
        for (int i = 0; i <= parts; i++) {
            const DVec3 p = glm::mix(wood.from, wood.to, static_cast<double>(i) / std::max(parts, 1));
            if (near(p, 0.0, axis)) leave_out(p, wood.radius, axis);
        }
    }
}

class Proposer {
  public:
    Proposer(const Tree& tree, const PointCloud& cloud, const GrowthRecipe& recipe, Progress* progress)
        : tree_(tree),
          recipe_(recipe),
          list_(list_branches(tree)),
          planned_(plan_tree(tree, list_, recipe.longest, recipe.shortest, recipe.steps)),
          axes_(tree, list_, planned_),
          progress_(progress) {
        if (progress) progress->update(0.0, "Lumps of the scan");
        const std::vector<DVec3> points = points_near(tree, cloud);
        spots_.resize(planned_.plan.branches.size());
        for (const BarkSpot& spot : axes_.find_all(points, progress))
            spots_[static_cast<size_t>(spot.branch)].push_back(spot);
    }

    GrowthProposal propose() {
        bool seen = false;
        for (size_t b = 0; b < spots_.size(); b++) {
            if (progress_)
                progress_->update(0.3 + 0.7 * static_cast<double>(b) / static_cast<double>(spots_.size()),
                                  "Lumps of the scan");
            seen |= look_at(static_cast<int32_t>(b));
        }
        if (!seen)
            proposal_.remarks.emplace_back(
                "The scan has too few points on the bark to tell lumps: nothing is proposed. Is it the scan "
                "that this tree was made of?");
        return std::move(proposal_);
    }

  private:
    // Whether the scan shows enough of the branch.
    bool look_at(int32_t branch) {
        const double begin = axes_.own_part(branch).first;
        const GrowthBranch& own = planned_.plan.branches[static_cast<size_t>(branch)];
        double end = axes_.own_part(branch).second;
        const double thinnest = kLeastWood * recipe_.longest;
        // Thinner wood has too few sides for lumps.
        for (const AxisPlace& place : own.axis) {
            if (place.along < begin || place.along > end || place.radius >= thinnest) continue;
            end = place.along;
            break;
        }
        if (end - begin < 2.0 * recipe_.longest) return false;
        const double wood = place_at(own, 0.5 * (begin + end)).radius;
        const std::vector<BarkSpot>& spots = spots_[static_cast<size_t>(branch)];
        const auto map_with = [&](double cell) {
            const double columns =
                std::clamp(std::round(2.0 * kPi * wood / cell), kFewestColumns, kMostColumns);
            return map_bark(own, spots, begin, end, cell, static_cast<size_t>(columns));
        };
        std::vector<double> counts;
        for (const uint32_t count : map_with(recipe_.longest).count)
            if (count > 0) counts.push_back(count);
        if (counts.empty()) return false;
        const double apart = recipe_.longest / std::sqrt(quantile(counts, 0.5));
        BarkMap map = map_with(std::max(kFinest * recipe_.longest, kApart * apart));
        leave_out_forks(tree_, list_, planned_, axes_, branch, map);
        // What runs along the branch, as flutes and buttresses do, is no row of lumps.
        BarkMap rest = map;
        const SectionFit flutes = fit_sections(map, recipe_.longest, Along::kLong, progress_);
        const std::vector<double> fluted = heights_of(map, flutes.sections);
        for (size_t cell = 0; cell < fluted.size(); cell++)
            rest.height[cell] -= fluted[cell];
        const Lumps found = fit_lumps(rest, recipe_.longest, progress_);
        take_off(found, map);
        // The grain winds about all wood alike; the trunk tells how.
        if (branch == 0)
            if (const std::optional<double> twist = fit_twist(map)) add_grain(*twist);
        const SectionFit outline = fit_sections(map, recipe_.longest, Along::kShort, progress_);
        BranchSections shape;
        for (const FittedSection& section : thinned(outline.sections, kTolerance))
            add_section(branch, section, shape);
        for (const Lump& lump : found.lumps)
            add_burl(branch, lump, shape);
        for (const Dent& dent : found.dents)
            add_hollow(branch, dent);
        return true;
    }

    void begin_line(const char* name, int32_t branch, double along, double around) {
        line_ = name;
        const Branch& listed =
            list_.branches[static_cast<size_t>(planned_.branch_of[static_cast<size_t>(branch)])];
        const NodeId node = list_.nodes[static_cast<size_t>(listed.begin)];
        double from = 0.0;
        if (listed.parent >= 0) {
            from = along_of(tree_, planned_.plan.branches[static_cast<size_t>(branch)], node);
            append_word(line_, "node", std::to_string(node));
        }
        put("along", along - from, 1000.0);
        put("around", std::fmod(360.0 * around, 359.5), 1.0);
    }
    // steps: of a whole, to which it is rounded.
    void put(const char* key, double value, double steps) {
        append_word(line_, key, number_text(std::round(value * steps) / steps));
    }
    void end_line() { proposal_.recipe += line_ + "\n"; }

    void add_grain(double twist) {
        proposal_.twist = std::round(100.0 * twist) / 100.0;
        line_ = "grain";
        put("twist", proposal_.twist, 100.0);
        end_line();
        proposal_.remarks.push_back("The scan's bark winds about the trunk by " +
                                    number_text(proposal_.twist) +
                                    " radians a metre, and so does the grain.");
    }

    void add_section(int32_t branch, const FittedSection& section, BranchSections& shape) {
        begin_line("section", branch, section.along, 0.0);
        std::string radii;
        std::vector<double> shares;
        const bool round = std::all_of(section.shares.begin(), section.shares.end(),
                                       [](double share) { return std::abs(share - 1.0) < 0.5 * kTolerance; });
        for (size_t i = 0; i < (round ? 3 : section.shares.size()); i++) {
            shares.push_back(round ? 1.0 : std::round(1000.0 * section.shares[i]) / 1000.0);
            radii += (i > 0 ? "," : "") + number_text(shares.back());
        }
        append_word(line_, "radii", radii);
        end_line();
        shape.add(section.along, 0.0, shares);
        proposal_.sections++;
    }

    // Height is k S_c times the steps that are left (Mizoguchi and Miyata 2014, equation 6).
    void add_burl(int32_t branch, const Lump& lump, const BranchSections& shape) {
        const GrowthPlan& plan = planned_.plan;
        const AxisPlace place = place_at(plan.branches[static_cast<size_t>(branch)], lump.along);
        const double age = std::max(plan.steps - place.step, 1.0);
        const double left = plan.steps - std::ceil(place.step + kLumpFrom * age);
        const double pace = std::max(pace_of(shape.share(lump.along, lump.around)), kLeastPace);
        const double speed = pace * (place.radius - std::min(plan.young, place.radius)) / age;
        const double growth = lump.height / (std::max(left, 1.0) * std::max(speed, 1e-9));
        begin_line("burl", branch, lump.along, lump.around);
        put("radius", lump.radius, 1000.0);
        put("inner", lump.inner, 1000.0);
        put("growth", std::min(growth, kMostGrowth), 100.0);
        put("from", kLumpFrom, 100.0);
        end_line();
        proposal_.burls++;
    }

    void add_hollow(int32_t branch, const Dent& dent) {
        begin_line("hollow", branch, dent.along, dent.around);
        put("width", dent.width, 1000.0);
        put("height", dent.length, 1000.0);
        put("depth", dent.depth, 1000.0);
        put("from", kHollowFrom, 100.0);
        put("until", kHollowUntil, 100.0);
        put("growth", 0.0, 1.0);
        put("wrap", 0.0, 1.0);
        end_line();
        proposal_.hollows++;
    }

    const Tree& tree_;
    const GrowthRecipe& recipe_;
    const BranchList list_;
    const TreePlan planned_;
    const BarkAxes axes_;
    Progress* progress_;
    std::vector<std::vector<BarkSpot>> spots_;  // by branch of the plan
    GrowthProposal proposal_;
    std::string line_;
};

}  // namespace

GrowthProposal propose_growth(const Tree& tree, const PointCloud& cloud, const GrowthRecipe& recipe,
                              Progress* progress) {
    if (tree.size() < 2) throw Error("The tree has no wood that lumps could be on.");
    return Proposer(tree, cloud, recipe, progress).propose();
}

}  // namespace treerec
