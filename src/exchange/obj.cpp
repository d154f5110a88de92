#include "exchange/obj.h"

#include <charconv>
#include <cmath>
#include <cstring>

#include "error.h"
#include "exchange/finite.h"
#include "file_bytes.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

constexpr size_t kChunk = 8192;  // vertices or triangles formatted at a time

// Appends to a char array that has room: the caller reserves the longest line times the lines.
struct Writer {
    char* at;

    void text(const char* s) {
        const size_t length = std::strlen(s);
        std::memcpy(at, s, length);
        at += length;
    }
    void integer(uint64_t value) { at = std::to_chars(at, at + 20, value).ptr; }
    // With `decimals` digits after the point, without trailing zeros; below zero: as many as it takes.
    void number(float value, int decimals) {
        if (decimals < 0) {
            at = std::to_chars(at, at + 48, value).ptr;
            return;
        }
        static constexpr double kScales[] = {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6};
        const double scaled = std::abs(static_cast<double>(value)) * kScales[decimals] + 0.5;
        if (!(scaled < 9e15)) {
            at = std::to_chars(at, at + 48, value).ptr;
            return;
        }
        auto digits = static_cast<uint64_t>(scaled);
        if (value < 0.0f && digits > 0) *at++ = '-';
        const auto unit = static_cast<uint64_t>(kScales[decimals]);
        integer(digits / unit);
        digits %= unit;
        if (digits == 0) return;
        *at++ = '.';
        for (uint64_t place = unit / 10; digits > 0; place /= 10) {
            *at++ = static_cast<char>('0' + digits / place);
            digits %= place;
        }
    }
};

// Formats lines 0..count in parallel, `longest` bytes each at most, and appends them to `out` in order.
template <typename Line>
void append_lines(std::string& out, size_t count, size_t longest, const Progress* progress,
                  const Line& line) {
    std::vector<std::string> parts((count + kChunk - 1) / kChunk);
    parallel_for(count, kChunk, [&](size_t begin, size_t end) {
        if (progress) progress->check();
        std::string& part = parts[begin / kChunk];
        part.resize((end - begin) * longest);
        Writer writer{part.data()};
        for (size_t i = begin; i < end; i++)
            line(writer, i);
        part.resize(static_cast<size_t>(writer.at - part.data()));
    });
    size_t size = out.size();
    for (const std::string& part : parts)
        size += part.size();
    out.reserve(size);
    for (const std::string& part : parts)
        out += part;
}

// A hundredth of a millimetre will do, but for what is hardly larger.
int decimals_for(const Mesh& mesh) {
    constexpr float kSmall = 0.05f;  // metres
    for (const Vec3& p : mesh.positions)
        if (std::abs(p.x) > kSmall || std::abs(p.y) > kSmall || std::abs(p.z) > kSmall) return 5;
    return -1;
}

void append_mesh(std::string& out, const Mesh& mesh, const std::string& name, uint64_t first,
                 const Progress* progress) {
    out += "o " + name + "\n";
    const size_t count = mesh.positions.size();
    const int decimals = decimals_for(mesh);
    append_lines(out, count, 160, progress, [&](Writer& writer, size_t i) {
        writer.text("v");
        for (int axis = 0; axis < 3; axis++) {
            writer.text(" ");
            writer.number(mesh.positions[i][axis], decimals);
        }
        writer.text("\n");
    });
    append_lines(out, count, 110, progress, [&](Writer& writer, size_t i) {
        writer.text("vt ");
        writer.number(mesh.uvs[i].x, 5);
        writer.text(" ");
        writer.number(1.0f - mesh.uvs[i].y, 5);  // OBJ counts v upwards
        writer.text("\n");
    });
    append_lines(out, count, 160, progress, [&](Writer& writer, size_t i) {
        writer.text("vn");
        for (int axis = 0; axis < 3; axis++) {
            writer.text(" ");
            writer.number(mesh.normals[i][axis], 4);
        }
        writer.text("\n");
    });
    out += "usemtl " + name + "\n";
    append_lines(out, mesh.triangle_count(), 210, progress, [&](Writer& writer, size_t i) {
        writer.text("f");
        for (size_t k = 0; k < 3; k++) {
            const uint64_t index = first + mesh.indices[3 * i + k];
            writer.text(" ");
            const char* number = writer.at;
            writer.integer(index);
            const auto length = static_cast<size_t>(writer.at - number);
            for (int repeat = 0; repeat < 2; repeat++) {
                *writer.at++ = '/';
                std::memcpy(writer.at, number, length);
                writer.at += length;
            }
        }
        writer.text("\n");
    });
}

}  // namespace

void write_obj(const std::string& path, const ModelFile& model, const Progress* progress) {
    const std::string stem = stem_of(path);
    const bool bark = model.bark && !model.bark->indices.empty();
    const bool leaves = model.leaves && !model.leaves->indices.empty();
    if (bark) require_finite(*model.bark, path);
    if (leaves) require_finite(*model.leaves, path);
    const auto drawn = [](const Mesh* mesh) { return mesh && !mesh->indices.empty(); };
    bool any = bark || leaves;
    for (const Mesh* other : model.other_leaves) {
        any = any || drawn(other);
        if (drawn(other)) require_finite(*other, path);
    }
    std::string out = "# Metres, Y up.\n";
    std::string materials;
    if (any) {
        out += "mtllib " + stem + ".mtl\n";
        const std::vector<NamedPicture> pictures =
            model.pictures.empty() ? pictures_of_model(make_pictures(model.preset), false) : model.pictures;
        for (const NamedPicture& picture : pictures) {
            const bool used = picture.name.starts_with("bark") ? bark : leaves;
            // MTL takes a roughness from a grey picture, and knows no occlusion.
            if (!used || picture.name == "bark_roughness") continue;
            const std::string name = stem + "_" + picture.name + picture_ending(picture.name);
            write_file(sibling_of(path, name), picture.bytes, progress);
        }
    }
    if (bark) {
        materials += "newmtl bark\nKd 1 1 1\nKs 0 0 0\nPr 1\nmap_Kd " + stem + "_bark_albedo.jpg\nmap_Pr " +
                     stem + "_bark_roughness_grey.png\nnorm " + stem + "_bark_normal.jpg\nmap_Bump " + stem +
                     "_bark_normal.jpg\n";
        append_mesh(out, *model.bark, "bark", 1, progress);
    }
    uint64_t next = bark ? model.bark->positions.size() + 1 : 1;
    const auto add_leaves = [&](const Mesh& mesh, const std::string& suffix) {
        const std::string picture = stem + "_leaf_";
        materials += "newmtl leaves" + suffix + "\nKd 1 1 1\nKs 0 0 0\nPr 0.7\nmap_Kd " + picture + "albedo" +
                     suffix + ".png\nmap_d " + picture + "albedo" + suffix + ".png\nnorm " + picture +
                     "normal" + suffix + ".png\nmap_Bump " + picture + "normal" + suffix + ".png\n";
        append_mesh(out, mesh, "leaves" + suffix, next, progress);
        next += mesh.positions.size();
    };
    if (leaves) add_leaves(*model.leaves, "");
    for (size_t i = 0; i < model.other_leaves.size(); i++) {
        if (!drawn(model.other_leaves[i])) continue;
        std::string suffix = "_";
        suffix += std::to_string(i + 2);
        for (const NamedPicture& picture : model.other_materials.at(i).pictures)
            write_file(sibling_of(path, stem + "_" + picture.name + suffix + ".png"), picture.bytes,
                       progress);
        add_leaves(*model.other_leaves[i], suffix);
    }
    if (!materials.empty()) write_file(sibling_of(path, stem + ".mtl"), materials, progress);
    write_file(path, out, progress);
}

}  // namespace treerec
