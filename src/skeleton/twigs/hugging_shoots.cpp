#include "skeleton/twigs/hugging_shoots.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "geometry/parallel.h"
#include "skeleton/cylinders/bark.h"

namespace treerec {

namespace {

constexpr double kStout = 0.01;    // metres: the wood that is hugged,
constexpr double kThicker = 3.0;   // and so many times as thick as what hugs it
constexpr double kUnion = 1.3;     // radii
constexpr size_t kMostWood = 4;    // branches that meet in one place
constexpr double kNear = 2.0;      // radii: so near to an axis,
constexpr double kStandOff = 0.7;  // a shoot reaches so much of its length out of the bark,
constexpr double kHair = 3.0;      // radii: and farther than so near,
constexpr double kSprout = 0.1;    // metres: or so far out of the bark, as sprouts of stout trunks are

class HuggingShoots {
  public:
    HuggingShoots(const std::vector<SkeletonBranch>& branches, const std::vector<std::vector<Station>>& axes)
        : branches_(branches), axes_(axes), bark_(branches, axes), thin_(branches.size(), 0) {
        for (size_t l = 0; l < axes.size(); l++)
            thin_[l] = axes[l].front().radius < kStout ? 1 : 0;
    }

    // except: the thin branches are marked, and the branch itself is.
    bool hugs(size_t l, std::vector<uint8_t>& except) const {
        const std::vector<Station>& line = axes_[l];
        const Vec3 tip(line.back().position);
        double field = 0.0;
        std::array<int32_t, kMostWood> met{};
        size_t count = 0;
        uint32_t hint = 0;
        bool along = false;
        for (; count < kMostWood; count++) {
            const BarkPlace place = bark_.nearest(tip, kHair * bark_.thickest(), hint, &except);
            if (place.branch < 0) break;
            met[count] = place.branch;
            except[static_cast<size_t>(place.branch)] = 1;
            if (place.radius < kThicker * line.front().radius) continue;
            // Blinn's blobs (1982), as powers: one branch alone ends at its own surface.
            const double near = kUnion * place.radius / std::max(place.distance, 1e-9);
            field += near * near;
            along = along || place.outside() < std::min((kHair - 1.0) * place.radius, kSprout) ||
                    (place.distance < kNear * place.radius + kMargin &&
                     place.outside() < kStandOff * length_outside(l));
        }
        for (size_t i = 0; i < count; i++)
            except[static_cast<size_t>(met[i])] = 0;
        return along || field >= 1.0;
    }

    const std::vector<uint8_t>& thin() const { return thin_; }

  private:
    static constexpr double kMargin = 0.02;  // metres

    // Of a branch, from its parent's bark on, metres.
    double length_outside(size_t l) const {
        const std::vector<Station>& line = axes_[l];
        const Station& fork =
            axes_[static_cast<size_t>(branches_[l].parent)][static_cast<size_t>(branches_[l].attach)];
        double length = std::max(0.0, glm::distance(fork.position, line.front().position) - fork.radius);
        for (size_t i = 1; i < line.size(); i++)
            length += glm::distance(line[i].position, line[i - 1].position);
        return length;
    }

    const std::vector<SkeletonBranch>& branches_;
    const std::vector<std::vector<Station>>& axes_;
    const Bark bark_;
    std::vector<uint8_t> thin_;
};

}  // namespace

void drop_hugging_shoots(std::vector<SkeletonBranch>& branches, std::vector<std::vector<Station>>& axes) {
    const HuggingShoots shoots(branches, axes);
    std::vector<uint8_t> hugs(branches.size(), 0);
    parallel_for(branches.size(), 64, [&](size_t begin, size_t end) {
        std::vector<uint8_t> except = shoots.thin();
        for (size_t l = std::max<size_t>(begin, 1); l < end; l++) {
            if (axes[l].front().bridged) continue;
            const uint8_t was = except[l];
            except[l] = 1;
            hugs[l] = shoots.hugs(l, except) ? 1 : 0;
            except[l] = was;
        }
    });
    std::vector<uint32_t> bears(branches.size(), 0);
    for (const SkeletonBranch& branch : branches)
        if (branch.parent >= 0) bears[static_cast<size_t>(branch.parent)]++;
    // What bears only such shoots is one itself.
    for (size_t l = branches.size(); l-- > 1;) {
        if (bears[l] > 0) hugs[l] = 0;
        if (hugs[l] != 0) bears[static_cast<size_t>(branches[l].parent)]--;
    }
    remove_branches(branches, axes, hugs);
}

}  // namespace treerec
