#include "exchange/gltf.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "error.h"
#include "exchange/finite.h"
#include "file_bytes.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kLargestFile = 0xFFFFFF00;  // a .glb counts its bytes in 32 bits
constexpr size_t kChunk = 16384;             // vertices or indices converted at a time
constexpr uint32_t kGlbMagic = 0x46546C67, kGlbVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

// The numbers that glTF gives to things (specification 2.0, sections 3.8.4, 5.1.3, 5.11.5, 5.26).
constexpr int kUnsignedByte = 5121, kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;
constexpr int kRepeat = 10497, kClampToEdge = 33071, kLinear = 9729, kLinearMipmapLinear = 9987;
// What leaf.gdshader makes of the leaves' picture, on average of a crown, as light: tones, hues and shade.
constexpr std::array<double, 4> kLeafTint{0.66, 0.61, 0.48, 1.0};
constexpr double kLeafCutoff = 0.25;            // lets the outline be, which smaller mipmaps average away
constexpr char kPictureFolder[] = "_textures";  // after the model's name
constexpr size_t kMostShortIndices = 65535;     // vertices; the index 65535 itself is reserved

bool drawn(const Mesh* mesh) {
    return mesh && !mesh->indices.empty();
}

std::string_view bytes_of(const auto& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

// A model being put together: its JSON, and its one buffer as parts that mostly lie where they were made.
class Builder {
  public:
    explicit Builder(const ModelFile& file);

    Json json;
    std::vector<std::string_view> parts;  // multiples of 4 bytes
    size_t size = 0;                      // of all parts
    size_t geometry_parts = 0;            // the pictures come after these,
    size_t geometry_size = 0;             // and these bytes
    std::vector<NamedPicture> pictures;   // those of the model, in the order of its images

  private:
    size_t add_view(std::string_view bytes, int target);
    size_t add_accessor(std::string_view bytes, size_t count, int component, const char* type, int target);
    size_t add_indices(const Mesh& mesh);
    Json make_primitive(const Mesh& mesh, int material, const LeafTint& tint = {});
    size_t add_level(const ModelFile::Level& level, size_t number);
    void add_levels(const ModelFile& file);
    size_t add_texture(const std::vector<NamedPicture>& all, const std::string& name, int wrap,
                       const std::string& suffix = "");
    void add_leaf_material(const std::vector<NamedPicture>& all, const std::string& suffix,
                           const std::string& rule, bool tinted);

    static constexpr std::array<char, 4> kPadding{};
    std::deque<std::vector<uint16_t>> short_indices_;  // by mesh: what parts point into
    std::deque<std::vector<glm::u8vec4>> wind_;
    std::deque<std::vector<glm::u8vec4>> tints_;
    // The materials of what is drawn in any level; -1: of nothing. Leaves by kind, the tree's own first.
    int bark_material_ = -1;
    std::vector<int> leaf_materials_;
    std::vector<LeafTint> tint_of_;  // by kind
};

size_t Builder::add_view(std::string_view bytes, int target) {
    const size_t padding = (4 - bytes.size() % 4) % 4;
    if (size + bytes.size() + padding > kLargestFile)
        throw Error("The model is larger than 4 GB; simplify the tree or write fewer leaves.");
    Json view = {{"buffer", 0}, {"byteOffset", size}, {"byteLength", bytes.size()}};
    if (target) view["target"] = target;
    json["bufferViews"].push_back(std::move(view));
    parts.push_back(bytes);
    parts.emplace_back(kPadding.data(), padding);
    size += bytes.size() + padding;
    return json["bufferViews"].size() - 1;
}

size_t Builder::add_accessor(std::string_view bytes, size_t count, int component, const char* type,
                             int target) {
    Json accessor = {{"bufferView", add_view(bytes, target)}, {"componentType", component}};
    if (component == kUnsignedByte) accessor["normalized"] = true;
    accessor["count"] = count;
    accessor["type"] = type;
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
}

size_t Builder::add_indices(const Mesh& mesh) {
    const size_t count = mesh.indices.size();
    if (mesh.positions.size() > kMostShortIndices)
        return add_accessor(bytes_of(mesh.indices), count, kUnsignedInt, "SCALAR", kIndexBuffer);
    std::vector<uint16_t>& indices = short_indices_.emplace_back();
    indices.resize(count);
    std::transform(mesh.indices.begin(), mesh.indices.end(), indices.begin(),
                   [](uint32_t index) { return static_cast<uint16_t>(index); });
    return add_accessor(bytes_of(indices), count, kUnsignedShort, "SCALAR", kIndexBuffer);
}

Json Builder::make_primitive(const Mesh& mesh, int material, const LeafTint& tint) {
    const size_t count = mesh.positions.size();
    std::vector<glm::u8vec4>& wind = wind_.emplace_back();
    wind.resize(count);
    std::vector<std::pair<Vec3, Vec3>> bounds((count + kChunk - 1) / kChunk);
    parallel_for(count, kChunk, [&](size_t begin, size_t end) {
        Vec3 low = mesh.positions[begin], high = low;
        for (size_t i = begin; i < end; i++) {
            low = glm::min(low, mesh.positions[i]);
            high = glm::max(high, mesh.positions[i]);
        }
        bounds[begin / kChunk] = {low, high};
        // A plain loop over the numbers: several are converted at once.
        const float* const from = &mesh.colors[begin].x;
        uint8_t* const to = &wind[begin].x;
        for (size_t i = 0; i < 4 * (end - begin); i++)
            to[i] = static_cast<uint8_t>(std::clamp(from[i], 0.0f, 1.0f) * 255.0f + 0.5f);
    });
    auto [low, high] = bounds[0];
    for (const auto& [least, most] : bounds) {
        low = glm::min(low, least);
        high = glm::max(high, most);
    }
    Json primitive;
    primitive["indices"] = add_indices(mesh);
    Json& attributes = primitive["attributes"];
    const auto add = [&](const char* attribute, std::string_view bytes, int component, const char* type) {
        attributes[attribute] = add_accessor(bytes, count, component, type, kVertexBuffer);
    };
    add("POSITION", bytes_of(mesh.positions), kFloat, "VEC3");
    json["accessors"].back()["min"] = {low.x, low.y, low.z};
    json["accessors"].back()["max"] = {high.x, high.y, high.z};
    add("NORMAL", bytes_of(mesh.normals), kFloat, "VEC3");
    add("TANGENT", bytes_of(mesh.tangents), kFloat, "VEC4");
    add("TEXCOORD_0", bytes_of(mesh.uvs), kFloat, "VEC2");
    add("_WIND", bytes_of(wind), kUnsignedByte, "VEC4");
    if (tint) {
        std::vector<glm::u8vec4>& tints = tints_.emplace_back(count);
        parallel_for(count, kChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++)
                tints[i] = glm::u8vec4(Vec4(tint(mesh.positions[i], mesh.colors[i].w), 1.0f) * 255.0f + 0.5f);
        });
        add("COLOR_0", bytes_of(tints), kUnsignedByte, "VEC4");
    }
    primitive["material"] = material;
    return primitive;
}

size_t Builder::add_texture(const std::vector<NamedPicture>& all, const std::string& picture_name, int wrap,
                            const std::string& suffix) {
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const NamedPicture& picture) { return picture.name == picture_name; });
    if (found == all.end()) throw Error("The model lacks the picture '" + picture_name + "'.");
    // Two kinds of leaves may show one picture.
    const auto kept = std::find_if(pictures.begin(), pictures.end(),
                                   [&](const NamedPicture& picture) { return picture.png == found->png; });
    if (kept != pictures.end() && !suffix.empty()) return static_cast<size_t>(kept - pictures.begin());
    const std::string name = picture_name + suffix;
    pictures.push_back(*found);
    pictures.back().name = name;
    json["images"].push_back(
        {{"name", name}, {"mimeType", "image/png"}, {"bufferView", add_view(found->png, 0)}});
    const Json sampler = {
        {"magFilter", kLinear}, {"minFilter", kLinearMipmapLinear}, {"wrapS", wrap}, {"wrapT", wrap}};
    Json& samplers = json["samplers"];
    auto same = std::find(samplers.begin(), samplers.end(), sampler);
    const auto index = static_cast<size_t>(same - samplers.begin());
    if (same == samplers.end()) samplers.push_back(sampler);
    json["textures"].push_back({{"name", name}, {"sampler", index}, {"source", json["images"].size() - 1}});
    return json["textures"].size() - 1;
}

// Of the names of what belongs to the leaves of a further kind.
std::string kind_suffix(size_t other) {
    std::string suffix = "_";
    return suffix += std::to_string(other + 2);
}

Json texture_info(size_t index) {
    return Json::object({{"index", index}});
}

// A node with what is drawn of a level as one mesh: tools that scatter meshes take each for a level by its
// name. Returns the node's number.
size_t Builder::add_level(const ModelFile::Level& level, size_t number) {
    const std::string name = "Tree_LOD" + std::to_string(number);
    Json primitives = Json::array();
    const auto add = [&](const Mesh* mesh, int material, const LeafTint& tint = {}) {
        if (drawn(mesh)) primitives.push_back(make_primitive(*mesh, material, tint));
    };
    add(level.bark, bark_material_);
    add(level.leaves, leaf_materials_[0], tint_of_[0]);
    for (size_t i = 0; i < level.other_leaves.size(); i++)
        add(level.other_leaves[i], leaf_materials_[i + 1], tint_of_[i + 1]);
    Json node = {{"name", name}};
    if (!primitives.empty()) {
        node["mesh"] = json["meshes"].size();
        json["meshes"].push_back({{"name", name}, {"primitives", std::move(primitives)}});
    }
    json["nodes"].push_back(std::move(node));
    return json["nodes"].size() - 1;
}

// The finest level is in the scene; the others are known to it alone (MSFT_lod), in the order of their
// detail.
void Builder::add_levels(const ModelFile& file) {
    // The share of a square screen, 75 degrees high, that a tree as wide as high covers from that far away.
    // The extension's text gives each level the least share that it is drawn at, of the screen's area.
    const auto coverage = [](double distance) {
        constexpr double kHalfHeight = 0.767327;  // the tangent of half the angle
        const double high = 0.5 / (kHalfHeight * std::max(distance, 1e-3));
        return std::min(high * high, 1.0);
    };
    Json ids = Json::array(), coverages = Json::array();
    const size_t finest = add_level({file.bark, file.leaves, 0.0, file.other_leaves}, 0);
    json["nodes"][0]["children"] = {finest};
    if (file.coarser.empty()) return;
    for (size_t i = 0; i < file.coarser.size(); i++) {
        ids.push_back(add_level(file.coarser[i], i + 1));
        coverages.push_back(coverage(file.coarser[i].distance));
    }
    coverages.push_back(0.0);  // the coarsest one to the horizon
    json["nodes"][finest]["extensions"]["MSFT_lod"]["ids"] = std::move(ids);
    json["nodes"][finest]["extras"]["MSFT_screencoverage"] = std::move(coverages);
    json["extensionsUsed"] = {"MSFT_lod"};
}

Builder::Builder(const ModelFile& file) {
    json["asset"] = {{"version", "2.0"}, {"generator", "Godot tree reconstruction (treerec)"}};
    json["scene"] = 0;
    json["scenes"] = Json::array({{{"name", "Tree"}, {"nodes", {0}}}});
    json["nodes"] = Json::array({{{"name", "Tree"}}});
    for (const char* list :
         {"meshes", "materials", "textures", "images", "samplers", "accessors", "bufferViews"})
        json[list] = Json::array();
    for (const auto& [name, value] : file.extras)
        json["nodes"][0]["extras"][name] = value;
    // Geometry first: the pictures at the buffer's end can then be cut off into files of their own.
    bool has_bark = false;
    std::vector<bool> has_leaves(1 + file.other_leaves.size(), false);
    const auto look_at = [&](const Mesh* bark, const Mesh* leaves, const std::vector<const Mesh*>& others) {
        has_bark = has_bark || drawn(bark);
        has_leaves[0] = has_leaves[0] || drawn(leaves);
        for (size_t i = 0; i < others.size(); i++)
            has_leaves.at(i + 1) = has_leaves[i + 1] || drawn(others[i]);
    };
    look_at(file.bark, file.leaves, file.other_leaves);
    for (const ModelFile::Level& level : file.coarser)
        look_at(level.bark, level.leaves, level.other_leaves);
    int materials = 0;
    if (has_bark) bark_material_ = materials++;
    for (const bool has : has_leaves)
        leaf_materials_.push_back(has ? materials++ : -1);
    tint_of_.push_back(file.leaf_tint);
    for (size_t i = 0; i < file.other_leaves.size(); i++)
        tint_of_.push_back(file.other_materials.at(i).tint);
    if (materials > 0) add_levels(file);
    geometry_parts = parts.size();
    geometry_size = size;
    const std::vector<NamedPicture> all =
        file.pictures.empty() && size > 0 ? make_pictures(file.preset) : file.pictures;
    if (has_bark) {
        Json material, surface;
        material["name"] = "bark";
        surface["baseColorTexture"] = texture_info(add_texture(all, "bark_albedo", kRepeat));
        material["normalTexture"] = texture_info(add_texture(all, "bark_normal", kRepeat));
        const size_t roughness = add_texture(all, "bark_roughness", kRepeat);
        surface["metallicRoughnessTexture"] = texture_info(roughness);
        material["occlusionTexture"] = texture_info(roughness);
        material["pbrMetallicRoughness"] = std::move(surface);
        json["materials"].push_back(std::move(material));
    }
    if (has_leaves[0]) add_leaf_material(all, "", "", bool(file.leaf_tint));
    for (size_t i = 0; i < file.other_leaves.size(); i++)
        if (has_leaves[i + 1])
            add_leaf_material(file.other_materials.at(i).pictures, kind_suffix(i),
                              file.other_materials[i].rule, bool(file.other_materials[i].tint));
    if (size > 0) json["buffers"] = Json::array({{{"byteLength", size}}});
    // glTF knows no empty lists.
    for (auto list = json.begin(); list != json.end();)
        list = list->is_array() && list->empty() ? json.erase(list) : std::next(list);
}

// suffix, rule: of a further kind of leaves; empty for the tree's own. tinted: by vertex.
void Builder::add_leaf_material(const std::vector<NamedPicture>& all, const std::string& suffix,
                                const std::string& rule, bool tinted) {
    Json material, surface;
    material["name"] = "leaves" + suffix;
    surface["baseColorTexture"] = texture_info(add_texture(all, "leaf_albedo", kClampToEdge, suffix));
    if (!tinted) surface["baseColorFactor"] = kLeafTint;
    surface["metallicFactor"] = 0.0;
    surface["roughnessFactor"] = 1.0;  // a crown of many small mirrors would be white
    material["pbrMetallicRoughness"] = std::move(surface);
    material["normalTexture"] = texture_info(add_texture(all, "leaf_normal", kClampToEdge, suffix));
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = kLeafCutoff;
    if (!rule.empty()) material["extras"]["leaf_rule"] = rule;
    json["materials"].push_back(std::move(material));
}

// A file's name as part of a URI (RFC 3986).
std::string percent_encoded(const std::string& name) {
    static constexpr char kDigits[] = "0123456789ABCDEF";
    std::string uri;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::strchr("-._~", c) != nullptr;
        if (plain && c != '\0') {
            uri += c;
        } else {
            uri += '%';
            uri += kDigits[byte >> 4];
            uri += kDigits[byte & 15];
        }
    }
    return uri;
}

void append_u32(std::string& bytes, size_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        bytes += static_cast<char>(value >> shift & 0xFF);
}

// The pictures as files of a folder beside the model, which the model names.
void write_pictures(const std::string& path, Builder& model, const Progress* progress) {
    if (model.pictures.empty()) return;
    const std::string folder = stem_of(path) + kPictureFolder;
    std::error_code code;
    std::filesystem::create_directory(path_of(sibling_of(path, folder)), code);
    if (code)
        throw Error(
            "The folder '" + sibling_of(path, folder) +
            "' for the pictures could not be made; check the rights, or whether a file has its name.");
    for (size_t i = 0; i < model.pictures.size(); i++) {
        const std::string name = model.pictures[i].name + ".png";
        write_file(sibling_of(path, folder + "/" + name), model.pictures[i].png, progress);
        model.json["images"][i] = {{"name", model.pictures[i].name},
                                   {"uri", percent_encoded(folder) + "/" + percent_encoded(name)}};
    }
    Json& views = model.json["bufferViews"];
    views.erase(views.end() - static_cast<std::ptrdiff_t>(model.pictures.size()), views.end());
    model.parts.resize(model.geometry_parts);
    model.size = model.geometry_size;
    model.json["buffers"][0]["byteLength"] = model.size;
}

// One file: header, JSON, buffer (specification 2.0, section 4).
void write_glb(const std::string& path, const Builder& model, const Progress* progress) {
    std::string text = model.json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const size_t buffer = model.size > 0 ? 8 + model.size : 0;
    std::string head, chunk;
    append_u32(head, kGlbMagic);
    append_u32(head, kGlbVersion);
    append_u32(head, 12 + 8 + text.size() + buffer);
    append_u32(head, text.size());
    append_u32(head, kJsonChunk);
    if (buffer > 0) {
        append_u32(chunk, model.size);
        append_u32(chunk, kBinChunk);
    }
    std::vector<std::string_view> parts{head, text, chunk};
    parts.insert(parts.end(), model.parts.begin(), model.parts.end());
    write_file(path, parts, progress);
}

// JSON and buffer, each in a file, the JSON last.
void write_json(const std::string& path, Builder& model, const Progress* progress) {
    const std::string stem = stem_of(path);
    if (model.size > 0) {
        write_file(sibling_of(path, stem + ".bin"), model.parts, progress);
        model.json["buffers"][0]["uri"] = percent_encoded(stem + ".bin");
    }
    write_file(path, model.json.dump(1, '\t'), progress);
}

}  // namespace

void write_gltf(const std::string& path, const ModelFile& file, const Progress* progress) {
    const std::string extension = extension_of(path);
    if (extension != "glb" && extension != "gltf") throw Error("'" + path + "' must end in .glb or .gltf.");
    const auto check = [&](const Mesh* mesh) {
        if (mesh && !mesh->indices.empty()) require_finite(*mesh, path);
    };
    const auto check_all = [&](const std::vector<const Mesh*>& meshes) {
        for (const Mesh* mesh : meshes)
            check(mesh);
    };
    check_all({file.bark, file.leaves});
    check_all(file.other_leaves);
    for (const ModelFile::Level& level : file.coarser) {
        check_all({level.bark, level.leaves});
        check_all(level.other_leaves);
    }
    Builder model(file);
    if (extension == "gltf" || file.pictures_beside) write_pictures(path, model, progress);
    if (extension == "glb")
        write_glb(path, model, progress);
    else
        write_json(path, model, progress);
}

}  // namespace treerec
