// What the tubes of one tree are built by. Internal to mesh/.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "foliage/branch_axis.h"
#include "foliage/crown.h"
#include "foliage/wind.h"
#include "mesh/branch_tubes.h"
#include "mesh/collar.h"
#include "mesh/polygon.h"
#include "mesh/root_flare.h"
#include "mesh/tube_rings.h"
#include "mesh/twig_shares.h"
#include "mesh/uneven_section.h"
#include "tree/branches.h"

namespace treerec::tubes {

constexpr double kLargestTree = 1e6;      // metres from the origin
constexpr double kLeastShare = 1e-5;      // of the coordinates: thinner wood would vanish in floats
constexpr double kCollarRadius = 0.012;   // metres; thinner branches come out of the bark as they are,
constexpr double kWebRadius = 0.02;       // and from here on they have a collar of their own
constexpr double kHeartwood = 0.008;      // metres: bare wood looks like wood so thin, without bark
constexpr size_t kBranchesPerChunk = 32;  // of parallel work

// Of a tube about wood of such a radius in metres.
uint32_t sides_of(double radius, const TubeOptions& options);

// How one branch becomes a tube: where its rings lie in its chunk, and its vertices and indices in the mesh.
struct Tube {
    uint32_t first_ring = 0;
    uint32_t rings = 0;  // 0: not drawn
    uint32_t sides = 0;
    bool round_tip = false;
    bool cut = false;             // the tip is a cut face
    bool base = false;            // closed where it begins
    bool point = false;           // the last ring is only the apex
    bool plug = false;            // closed where it begins by flat faces on its own corners
    double exit = 0.0;            // metres along, where it leaves its parent's bark; 0 for the trunk
    double parent_radius = 0.0;   // metres, 0 for the trunk
    DVec3 parent_direction{0.0};  // unit, of the parent where the tube starts
    RootFlare flare;              // of a standing trunk,
    size_t foot_rows = 0;         // and its first rings, which show it
    UnevenSection section;
    Collar collar;             // on its parent's bark
    size_t first_collar = 0;   // its vertices in the chunk
    double base_radius = 0.0;  // metres, of the wood where it starts; coarser levels only
    uint32_t host_ring = 0;    // of the parent, below where this one starts
    size_t first_vertex = 0;
    size_t first_index = 0;

    size_t rows() const {
        return collar.rows + rings - collar.next_ring + (round_tip ? 1u : 0u) - (point ? 1u : 0u);
    }
    // A collar and the rim of a cut have two rows at one place, and no faces between them.
    size_t spans() const { return rows() - (collar.rows ? 2u : 1u) - (cut ? 1u : 0u); }
    size_t caps() const { return base ? sides + 2 : 0; }
    size_t vertices() const { return rings ? rows() * (sides + 1) + sides + caps() : 0; }
    size_t indices() const {
        return rings ? spans() * sides * 6 + sides * 3 + (base ? sides * 3 : 0) + (plug ? (sides - 2) * 3 : 0)
                     : 0;
    }
};

// Everything that the tubes of one tree share.
struct Builder {
    const Tree& tree;
    const TubeOptions& options;
    const BranchList list;
    const Crown crown;
    const WindGroups wind;
    const double least;                    // metres: the smallest radius and half the smallest ring distance
    std::vector<Tube> tubes;               // by branch
    std::vector<std::vector<Ring>> rings;  // by chunk of branches
    std::vector<std::vector<CollarVertex>> collars;  // by chunk of branches
    std::vector<float> widened;     // by branch: how many times its width it is drawn; 0: not at all
    std::vector<float> node_along;  // by node id: metres along its branch's axis
    std::vector<NodeId> continues;  // by node id: the next one of its branch, or kNoNode

    // coarseness: see share_twigs().
    Builder(const Tree& t, const TubeOptions& o, double coarseness)
        : tree(t),
          options(o),
          list(list_branches(t)),
          crown(measure_crown(t)),
          wind(t, list, crown.height),
          least(kLeastShare * crown.coordinate),
          tubes(list.branches.size()),
          rings((list.branches.size() + kBranchesPerChunk - 1) / kBranchesPerChunk),
          collars(rings.size()),
          widened(share_twigs(t, list, crown, coarseness)),
          node_along(static_cast<size_t>(t.id_end()), 0.0f),
          continues(static_cast<size_t>(t.id_end()), kNoNode) {
        take_grown();
        for (const Branch& branch : list.branches)
            for (int32_t i = branch.begin; i + 1 < branch.end; i++)
                continues[list.nodes[i]] = list.nodes[i + 1];
    }

    std::vector<double> covered;  // by branch: metres along that grown bark is drawn for

    void take_grown();
    // Leaves what is to be drawn as a tube; false for nothing.
    bool cut_covered(size_t index, std::vector<AxisPoint>& points) const;
    void add_grown(Mesh& mesh) const;

    TubeShape shape_of(size_t branch) const {
        const Tube& tube = tubes[branch];
        return {rings_of(branch), tube.rings, tube.sides, &tube.section};
    }
    const Ring* rings_of(size_t branch) const {
        return rings[branch / kBranchesPerChunk].data() + tubes[branch].first_ring;
    }

    // The largest radius that a ring about `attach` may have and still hide in its parent's tube: the parent
    // is a prism, and thins towards its next node.
    double hidden_radius(NodeId attach, double reach) const {
        const Node& node = tree.node(attach);
        double radius = node.radius;
        const Branch& parent = list.branches[list.branch_of[attach]];
        if (const NodeId next = continues[attach]; next != kNoNode) {
            const double distance = glm::distance(tree.node(next).position, node.position);
            const double t = distance > reach ? reach / distance : 1.0;
            radius = std::min(radius, radius + (tree.node(next).radius - radius) * t);
        }
        const double thickest = tree.node(list.nodes[parent.begin]).radius;
        return 0.92 * polygon_flat(sides_of(thickest, options)) * radius;
    }

    // Calls body(begin, end) for all branches, on several threads where they are worth it.
    void for_all(const Progress* progress, const std::function<void(size_t, size_t)>& body) const;
    void lay_out(const Progress* progress);
    size_t triangles() const;
    double coarseness_of(size_t triangles, double finer, double coarser) const;
    void plan(size_t index, std::vector<AxisPoint>& points);
    void seat(size_t index);
    void join(size_t index);
    // Coarser levels cover as much as level 0: see tube_widths.cpp.
    void widen(size_t index);
    std::vector<SectionPlace> sections_of(const Branch& branch) const;
    void stand(const std::vector<AxisPoint>& points, const std::vector<SectionPlace>& sections, Tube& tube,
               std::vector<Ring>& out) const;
    void add_collar(const Branch& branch, std::vector<AxisPoint>& points, Tube& tube) const;
    void pick_rings(const Branch& branch, const std::vector<AxisPoint>& points, const Tube& tube,
                    const std::vector<SectionPlace>& sections, std::vector<Ring>& out) const;
    double light_at(const Tube& tube, double start_radius, const DVec3& centre, double along,
                    double shade) const;
    float phase_of(size_t index) const {
        return static_cast<float>(branch_phase(list.nodes[list.branches[index].end - 1]));
    }
    // The wind's codes at a place of the drawn tube, so many metres along.
    Vec2 wind_at(size_t index, double along, const DVec3& place) const;
    double repeats_of(size_t index, double radius) const;
    void emit(size_t index, Mesh& mesh) const;
};

}  // namespace treerec::tubes
