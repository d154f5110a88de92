#include "mesh/grown_bark.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "error.h"
#include "geometry/random.h"
#include "tree/branches.h"

namespace treerec {

namespace {

constexpr std::string_view kMark = "treerec bark";
constexpr size_t kHeader = kMark.size() + 4;
constexpr int kBeyond = 2;           // nodes above the covered wood that bend its axis
constexpr double kOctant = 32767.0;  // steps of a packed normal

class Writer {
  public:
    void whole(uint64_t value, int bytes) {
        for (int i = 0; i < bytes; i++)
            out_.push_back(static_cast<char>(static_cast<uint8_t>(value >> (8 * i))));
    }
    void real(float value) { whole(std::bit_cast<uint32_t>(value), 4); }
    void real(double value) { whole(std::bit_cast<uint64_t>(value), 8); }
    // Seven bits a byte, the lowest first.
    void count(uint64_t value) {
        for (; value >= 0x80; value >>= 7)
            whole((value & 0x7f) | 0x80, 1);
        whole(value, 1);
    }
    void text(std::string_view text) { out_ += text; }
    std::string take() { return std::move(out_); }

  private:
    std::string out_;
};

[[noreturn]] void damaged() {
    throw Error("The saved bark is damaged. Grow it again.");
}

class Reader {
  public:
    explicit Reader(std::string_view in) : in_(in) {}

    uint64_t whole(int bytes) {
        if (in_.size() - at_ < static_cast<size_t>(bytes)) damaged();
        uint64_t value = 0;
        for (int i = 0; i < bytes; i++)
            value |= static_cast<uint64_t>(static_cast<uint8_t>(in_[at_++])) << (8 * i);
        return value;
    }
    float real() {
        const float value = std::bit_cast<float>(static_cast<uint32_t>(whole(4)));
        if (!std::isfinite(value)) damaged();
        return value;
    }
    double wide() { return std::bit_cast<double>(whole(8)); }
    uint64_t count() {
        uint64_t value = 0;
        for (int shift = 0; shift < 64; shift += 7) {
            const uint64_t byte = whole(1);
            value |= (byte & 0x7f) << shift;
            if (byte < 0x80) return value;
        }
        damaged();
    }
    // So many things of so many bytes at least are still to come.
    size_t count_of(size_t bytes) {
        const uint64_t many = whole(4);
        if (many > (in_.size() - at_) / bytes) damaged();
        return static_cast<size_t>(many);
    }
    bool done() const { return at_ == in_.size(); }

  private:
    std::string_view in_;
    size_t at_ = kHeader;
};

double sign_of(double value) {
    return value < 0.0 ? -1.0 : 1.0;
}

// A unit vector as a place of an octahedron that is folded flat (Cigolle et al., "A Survey of Efficient
// Representations for Independent Unit Vectors", 2014, section 3.2).
void write_normal(Writer& writer, const Vec3& normal) {
    const DVec3 n(normal);
    const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    DVec2 flat = sum > 0.0 ? DVec2(n.x, n.y) / sum : DVec2(0.0);
    if (n.z < 0.0)
        flat = {(1.0 - std::abs(flat.y)) * sign_of(flat.x), (1.0 - std::abs(flat.x)) * sign_of(flat.y)};
    for (const double value : {flat.x, flat.y})
        writer.whole(static_cast<uint16_t>(static_cast<int16_t>(std::lround(value * kOctant))), 2);
}

Vec3 read_normal(Reader& reader) {
    double flat[2];
    for (double& value : flat)
        value = static_cast<int16_t>(static_cast<uint16_t>(reader.whole(2))) / kOctant;
    DVec3 normal(flat[0], flat[1], 1.0 - std::abs(flat[0]) - std::abs(flat[1]));
    if (normal.z < 0.0) {
        normal.x = (1.0 - std::abs(flat[1])) * sign_of(flat[0]);
        normal.y = (1.0 - std::abs(flat[0])) * sign_of(flat[1]);
    }
    return Vec3(normalized_or(normal, DVec3(0.0, 1.0, 0.0)));
}

}  // namespace

uint64_t covered_wood_digest(const Tree& tree, const std::vector<GrownBark::Branch>& branches) {
    if (tree.empty()) return 0;
    const BranchList list = list_branches(tree);
    uint64_t digest = 1;
    const auto add = [&](double value) { digest = hash_seed(digest, std::bit_cast<uint64_t>(value)); };
    const auto add_node = [&](NodeId id) {
        const Node& node = tree.node(id);
        digest = hash_seed(digest, static_cast<uint64_t>(id));
        for (const double value : {node.position.x, node.position.y, node.position.z, node.radius})
            add(value);
    };
    for (const GrownBark::Branch& covered : branches) {
        if (!tree.contains(covered.first)) return 0;
        const Branch& branch = list.branches[static_cast<size_t>(list.branch_of[covered.first])];
        if (list.nodes[static_cast<size_t>(branch.begin)] != covered.first) return 0;
        add(covered.until);
        NodeId last = branch.attach;
        if (last != kNoNode) add_node(last);
        double along = 0.0;
        int beyond = 0;
        for (const NodeId id : list.nodes_of(branch)) {
            if (last != kNoNode) along += glm::distance(tree.node(last).position, tree.node(id).position);
            if (along > covered.until && ++beyond > kBeyond) break;
            add_node(id);
            last = id;
        }
    }
    return std::max<uint64_t>(digest, 1);
}

bool fits(const GrownBark& bark, const Tree& tree) {
    return !bark.empty() && bark.digest != 0 && covered_wood_digest(tree, bark.branches) == bark.digest;
}

std::string pack_grown_bark(const GrownBark& bark) {
    Writer writer;
    writer.text(kMark);
    writer.whole(kGrownBarkVersion, 4);
    writer.whole(bark.digest, 8);
    writer.whole(bark.branches.size(), 4);
    for (const GrownBark::Branch& branch : bark.branches) {
        writer.whole(static_cast<uint32_t>(branch.first), 4);
        writer.real(branch.until);
    }
    writer.whole(bark.vertices.size(), 4);
    for (const GrownBark::Vertex& vertex : bark.vertices) {
        for (const float value : {vertex.position.x, vertex.position.y, vertex.position.z, vertex.along,
                                  vertex.around, vertex.radius})
            writer.real(value);
        write_normal(writer, vertex.normal);
        writer.count(2 * static_cast<uint64_t>(vertex.branch) + (vertex.decayed ? 1 : 0));
    }
    // Neighbours come one after another: steps are short.
    writer.whole(bark.indices.size(), 4);
    uint32_t before = 0;
    for (const uint32_t index : bark.indices) {
        const uint32_t up = index - before, down = before - index;
        writer.count(index >= before ? 2 * static_cast<uint64_t>(up) : 2 * static_cast<uint64_t>(down) - 1);
        before = index;
    }
    writer.whole(bark.parents.size(), 4);
    for (size_t i = 0; i < bark.parents.size(); i++)
        writer.count(i - bark.parents[i]);
    return writer.take();
}

uint32_t packed_bark_version(std::string_view packed) {
    if (packed.size() < kHeader || !packed.starts_with(kMark)) return 0;
    uint32_t version = 0;
    for (size_t i = 0; i < 4; i++)
        version |= static_cast<uint32_t>(static_cast<uint8_t>(packed[kMark.size() + i])) << (8 * i);
    return version;
}

GrownBark unpack_grown_bark(std::string_view packed) {
    const uint32_t version = packed_bark_version(packed);
    if (version == 0) damaged();
    if (version > kGrownBarkVersion)
        throw Error("This bark was saved by a newer version of the addon (format " + std::to_string(version) +
                    "; this one reads up to " + std::to_string(kGrownBarkVersion) +
                    "). Update the addon to see it.");
    Reader reader(packed);
    GrownBark bark;
    bark.digest = reader.whole(8);
    bark.branches.resize(reader.count_of(12));
    for (GrownBark::Branch& branch : bark.branches) {
        branch.first = static_cast<NodeId>(static_cast<uint32_t>(reader.whole(4)));
        branch.until = reader.wide();
        if (branch.first < 0 || !(branch.until >= 0.0)) damaged();
    }
    bark.vertices.resize(reader.count_of(29));
    for (GrownBark::Vertex& vertex : bark.vertices) {
        for (float* value : {&vertex.position.x, &vertex.position.y, &vertex.position.z, &vertex.along,
                             &vertex.around, &vertex.radius})
            *value = reader.real();
        vertex.normal = read_normal(reader);
        const uint64_t owner = reader.count();
        if (owner / 2 >= bark.branches.size()) damaged();
        vertex.branch = static_cast<int32_t>(owner / 2);
        vertex.decayed = owner % 2 == 1;
    }
    bark.indices.resize(reader.count_of(1));
    if (bark.indices.size() % 3 != 0) damaged();
    uint32_t before = 0;
    for (uint32_t& index : bark.indices) {
        const uint64_t step = reader.count();
        const int64_t next =
            static_cast<int64_t>(before) +
            (step % 2 == 0 ? static_cast<int64_t>(step / 2) : -static_cast<int64_t>(step / 2) - 1);
        if (next < 0 || next >= static_cast<int64_t>(bark.vertices.size())) damaged();
        index = before = static_cast<uint32_t>(next);
    }
    if (version >= 2) {
        bark.parents.resize(reader.count_of(1));
        if (!bark.parents.empty() && bark.parents.size() != bark.vertices.size()) damaged();
        for (size_t i = 0; i < bark.parents.size(); i++) {
            const uint64_t before_it = reader.count();
            if (before_it > i) damaged();
            bark.parents[i] = static_cast<uint32_t>(i - before_it);
        }
    }
    if (!reader.done()) damaged();
    return bark;
}

}  // namespace treerec
