#include "exchange/gltf.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "error.h"
#include "exchange/finite.h"
#include "exchange/quiet_tiny_gltf.h"
#include "file_bytes.h"
#include "geometry/parallel.h"

namespace treerec {

namespace {

using Json = nlohmann::json;

constexpr size_t kLargestFile = 0xFFFFFF00;  // a .glb counts its bytes in 32 bits
constexpr size_t kChunk = 16384;             // vertices or indices converted at a time
constexpr uint32_t kGlbMagic = 0x46546C67, kGlbVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

// What leaf.gdshader makes of the leaves' picture, on average of a crown, as light: tones, hues and shade.
const std::vector<double> kLeafTint{0.66, 0.61, 0.48, 1.0};
constexpr double kLeafCutoff = 0.25;            // lets the outline be, which smaller mipmaps average away
constexpr char kPictureFolder[] = "_textures";  // after the model's name
constexpr size_t kMostShortIndices = 65535;     // vertices; the index 65535 itself is reserved

bool drawn(const Mesh* mesh) {
    return mesh && !mesh->indices.empty();
}

std::string_view bytes_of(const auto& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])};
}

// A model being put together: what tinygltf writes of it, and its one buffer as parts that mostly lie where
// they were made. tinygltf would copy the buffer three times, and count what it wrote of it for nothing.
class Builder {
  public:
    explicit Builder(const ModelFile& file);

    tinygltf::Model model;                // without its buffer
    std::vector<std::string_view> parts;  // multiples of 4 bytes
    size_t size = 0;                      // of all parts
    size_t geometry_parts = 0;            // the pictures come after these,
    size_t geometry_size = 0;             // and these bytes
    std::vector<NamedPicture> pictures;   // those of the model, in the order of its images

  private:
    int add_view(std::string_view bytes, int target);
    int add_accessor(std::string_view bytes, size_t count, int component, int type, int target);
    int add_indices(const Mesh& mesh);
    tinygltf::Primitive make_primitive(const Mesh& mesh, int material, const LeafTint& tint = {});
    int add_level(const ModelFile::Level& level, size_t number);
    void add_levels(const ModelFile& file);
    int add_texture(const std::vector<NamedPicture>& all, const std::string& name, int wrap,
                    const std::string& suffix = "");
    void add_bark_material(const std::vector<NamedPicture>& all);
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

// Puts it last and returns its index.
template <typename T>
int add_to(std::vector<T>& all, T one) {
    all.push_back(std::move(one));
    return static_cast<int>(all.size()) - 1;
}

int Builder::add_view(std::string_view bytes, int target) {
    const size_t padding = (4 - bytes.size() % 4) % 4;
    if (size + bytes.size() + padding > kLargestFile)
        throw Error("The model is larger than 4 GB; simplify the tree or write fewer leaves.");
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = size;
    view.byteLength = bytes.size();
    view.target = target;
    parts.push_back(bytes);
    parts.emplace_back(kPadding.data(), padding);
    size += bytes.size() + padding;
    return add_to(model.bufferViews, std::move(view));
}

int Builder::add_accessor(std::string_view bytes, size_t count, int component, int type, int target) {
    tinygltf::Accessor accessor;
    accessor.bufferView = add_view(bytes, target);
    accessor.componentType = component;
    accessor.normalized = component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    accessor.count = count;
    accessor.type = type;
    return add_to(model.accessors, std::move(accessor));
}

int Builder::add_indices(const Mesh& mesh) {
    const size_t count = mesh.indices.size();
    if (mesh.positions.size() > kMostShortIndices)
        return add_accessor(bytes_of(mesh.indices), count, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                            TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    std::vector<uint16_t>& indices = short_indices_.emplace_back();
    indices.resize(count);
    std::transform(mesh.indices.begin(), mesh.indices.end(), indices.begin(),
                   [](uint32_t index) { return static_cast<uint16_t>(index); });
    return add_accessor(bytes_of(indices), count, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                        TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

tinygltf::Primitive Builder::make_primitive(const Mesh& mesh, int material, const LeafTint& tint) {
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
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.indices = add_indices(mesh);
    const auto add = [&](const char* attribute, std::string_view bytes, int component, int type) {
        const int accessor = add_accessor(bytes, count, component, type, TINYGLTF_TARGET_ARRAY_BUFFER);
        primitive.attributes[attribute] = accessor;
        return static_cast<size_t>(accessor);
    };
    const size_t places =
        add("POSITION", bytes_of(mesh.positions), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    model.accessors[places].minValues = {low.x, low.y, low.z};
    model.accessors[places].maxValues = {high.x, high.y, high.z};
    add("NORMAL", bytes_of(mesh.normals), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
    add("TANGENT", bytes_of(mesh.tangents), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC4);
    add("TEXCOORD_0", bytes_of(mesh.uvs), TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC2);
    add("_WIND", bytes_of(wind), TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4);
    if (tint) {
        std::vector<glm::u8vec4>& tints = tints_.emplace_back(count);
        parallel_for(count, kChunk, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; i++)
                tints[i] = glm::u8vec4(Vec4(tint(mesh.positions[i], mesh.colors[i].w), 1.0f) * 255.0f + 0.5f);
        });
        add("COLOR_0", bytes_of(tints), TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4);
    }
    primitive.material = material;
    return primitive;
}

const char* mime_type(std::string_view picture_name) {
    return std::string_view(picture_ending(picture_name)) == ".jpg" ? "image/jpeg" : "image/png";
}

int Builder::add_texture(const std::vector<NamedPicture>& all, const std::string& picture_name, int wrap,
                         const std::string& suffix) {
    const auto found = std::find_if(
        all.begin(), all.end(), [&](const NamedPicture& picture) { return picture.name == picture_name; });
    if (found == all.end()) throw Error("The model lacks the picture '" + picture_name + "'.");
    // Two kinds of leaves may show one picture.
    const auto kept = std::find_if(pictures.begin(), pictures.end(), [&](const NamedPicture& picture) {
        return picture.bytes == found->bytes;
    });
    if (kept != pictures.end() && !suffix.empty()) return static_cast<int>(kept - pictures.begin());
    const std::string name = picture_name + suffix;
    pictures.push_back(*found);
    pictures.back().name = name;
    tinygltf::Image image;
    image.name = name;
    image.mimeType = mime_type(found->name);
    image.bufferView = add_view(found->bytes, 0);
    tinygltf::Texture texture;
    texture.name = name;
    texture.source = add_to(model.images, std::move(image));
    const auto same = std::find_if(model.samplers.begin(), model.samplers.end(),
                                   [&](const tinygltf::Sampler& sampler) { return sampler.wrapS == wrap; });
    texture.sampler = static_cast<int>(same - model.samplers.begin());
    if (same == model.samplers.end()) {
        tinygltf::Sampler sampler;
        sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
        sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        sampler.wrapS = sampler.wrapT = wrap;
        model.samplers.push_back(std::move(sampler));
    }
    return add_to(model.textures, std::move(texture));
}

// Of the names of what belongs to the leaves of a further kind.
std::string kind_suffix(size_t other) {
    std::string suffix = "_";
    return suffix += std::to_string(other + 2);
}

// A node with what is drawn of a level as one mesh: tools that scatter meshes take each for a level by its
// name. Returns the node's number.
int Builder::add_level(const ModelFile::Level& level, size_t number) {
    tinygltf::Node node;
    node.name = "Tree_LOD" + std::to_string(number);
    tinygltf::Mesh mesh;
    mesh.name = node.name;
    const auto add = [&](const Mesh* part, int material, const LeafTint& tint = {}) {
        if (drawn(part)) mesh.primitives.push_back(make_primitive(*part, material, tint));
    };
    add(level.bark, bark_material_);
    add(level.leaves, leaf_materials_[0], tint_of_[0]);
    for (size_t i = 0; i < level.other_leaves.size(); i++)
        add(level.other_leaves[i], leaf_materials_[i + 1], tint_of_[i + 1]);
    if (!mesh.primitives.empty()) node.mesh = add_to(model.meshes, std::move(mesh));
    return add_to(model.nodes, std::move(node));
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
    const int finest = add_level({file.bark, file.leaves, 0.0, file.other_leaves}, 0);
    model.nodes[0].children = {finest};
    if (file.coarser.empty()) return;
    tinygltf::Value::Array ids, coverages;
    for (size_t i = 0; i < file.coarser.size(); i++) {
        ids.emplace_back(add_level(file.coarser[i], i + 1));
        coverages.emplace_back(coverage(file.coarser[i].distance));
    }
    coverages.emplace_back(0.0);  // the coarsest one to the horizon
    tinygltf::Node& node = model.nodes[static_cast<size_t>(finest)];
    node.extensions["MSFT_lod"] = tinygltf::Value(tinygltf::Value::Object{{"ids", tinygltf::Value(ids)}});
    node.extras =
        tinygltf::Value(tinygltf::Value::Object{{"MSFT_screencoverage", tinygltf::Value(coverages)}});
    model.extensionsUsed = {"MSFT_lod"};
}

Builder::Builder(const ModelFile& file) {
    model.asset.version = "2.0";
    model.asset.generator = "Godot tree reconstruction (treerec)";
    model.defaultScene = 0;
    tinygltf::Scene scene;
    scene.name = "Tree";
    scene.nodes = {0};
    model.scenes.push_back(std::move(scene));
    tinygltf::Node root;
    root.name = "Tree";
    tinygltf::Value::Object extras;
    for (const auto& [name, value] : file.extras)
        extras[name] = tinygltf::Value(value);
    if (!extras.empty()) root.extras = tinygltf::Value(extras);
    model.nodes.push_back(std::move(root));
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
    if (has_bark) add_bark_material(all);
    if (has_leaves[0]) add_leaf_material(all, "", "", bool(file.leaf_tint));
    for (size_t i = 0; i < file.other_leaves.size(); i++)
        if (has_leaves[i + 1])
            add_leaf_material(file.other_materials.at(i).pictures, kind_suffix(i),
                              file.other_materials[i].rule, bool(file.other_materials[i].tint));
}

void Builder::add_bark_material(const std::vector<NamedPicture>& all) {
    tinygltf::Material material;
    material.name = "bark";
    tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
    constexpr int kWrap = TINYGLTF_TEXTURE_WRAP_REPEAT;
    surface.baseColorTexture.index = add_texture(all, "bark_albedo", kWrap);
    material.normalTexture.index = add_texture(all, "bark_normal", kWrap);
    surface.metallicRoughnessTexture.index = add_texture(all, "bark_roughness", kWrap);
    surface.metallicFactor = 0.0;  // the picture has something else there
    material.occlusionTexture.index = surface.metallicRoughnessTexture.index;
    model.materials.push_back(std::move(material));
}

// suffix, rule: of a further kind of leaves; empty for the tree's own. tinted: by vertex.
void Builder::add_leaf_material(const std::vector<NamedPicture>& all, const std::string& suffix,
                                const std::string& rule, bool tinted) {
    tinygltf::Material material;
    material.name = "leaves" + suffix;
    tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
    constexpr int kWrap = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    surface.baseColorTexture.index = add_texture(all, "leaf_albedo", kWrap, suffix);
    if (!tinted) surface.baseColorFactor = kLeafTint;
    surface.metallicFactor = 0.0;
    surface.roughnessFactor = 1.0;  // a crown of many small mirrors would be white
    material.normalTexture.index = add_texture(all, "leaf_normal", kWrap, suffix);
    material.alphaMode = "MASK";
    material.alphaCutoff = kLeafCutoff;
    if (!rule.empty())
        material.extras = tinygltf::Value(tinygltf::Value::Object{{"leaf_rule", tinygltf::Value(rule)}});
    model.materials.push_back(std::move(material));
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

// What tinygltf writes, with its one buffer. Sorted by name, so that the same model has the same bytes.
Json json_of(const Builder& built) {
    std::ostringstream text;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&built.model, text, false, false))
        throw Error("The model could not be put into words as glTF.");
    Json json = Json::parse(text.str());
    if (built.size > 0) json["buffers"] = Json::array({{{"byteLength", built.size}}});
    return json;
}

// The pictures as files of a folder beside the model, which the model names.
void write_pictures(const std::string& path, const Builder& built, Json& json, const Progress* progress) {
    if (built.pictures.empty()) return;
    const std::string folder = stem_of(path) + kPictureFolder;
    std::error_code code;
    std::filesystem::create_directory(path_of(sibling_of(path, folder)), code);
    if (code)
        throw Error(
            "The folder '" + sibling_of(path, folder) +
            "' for the pictures could not be made; check the rights, or whether a file has its name.");
    for (size_t i = 0; i < built.pictures.size(); i++) {
        const std::string name = built.pictures[i].name + picture_ending(built.pictures[i].name);
        write_file(sibling_of(path, folder + "/" + name), built.pictures[i].bytes, progress);
        json["images"][i] = {{"name", built.pictures[i].name},
                             {"mimeType", mime_type(built.pictures[i].name)},
                             {"uri", percent_encoded(folder) + "/" + percent_encoded(name)}};
    }
    Json& views = json["bufferViews"];
    views.erase(views.end() - static_cast<std::ptrdiff_t>(built.pictures.size()), views.end());
    json["buffers"][0]["byteLength"] = built.geometry_size;
}

// One file: header, JSON, buffer (specification 2.0, section 4).
void write_glb(const std::string& path, const Json& json, const std::vector<std::string_view>& buffer,
               const Progress* progress) {
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    size_t size = 0;
    for (const std::string_view part : buffer)
        size += part.size();
    std::string head, chunk;
    append_u32(head, kGlbMagic);
    append_u32(head, kGlbVersion);
    append_u32(head, 12 + 8 + text.size() + (size > 0 ? 8 + size : 0));
    append_u32(head, text.size());
    append_u32(head, kJsonChunk);
    if (size > 0) {
        append_u32(chunk, size);
        append_u32(chunk, kBinChunk);
    }
    std::vector<std::string_view> parts{head, text, chunk};
    parts.insert(parts.end(), buffer.begin(), buffer.end());
    write_file(path, parts, progress);
}

// JSON and buffer, each in a file, the JSON last.
void write_json(const std::string& path, Json& json, const std::vector<std::string_view>& buffer,
                const Progress* progress) {
    const std::string stem = stem_of(path);
    if (!buffer.empty()) {
        write_file(sibling_of(path, stem + ".bin"), buffer, progress);
        json["buffers"][0]["uri"] = percent_encoded(stem + ".bin");
    }
    write_file(path, json.dump(1, '\t'), progress);
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
    Builder built(file);
    Json json = json_of(built);
    if (extension == "gltf" || file.pictures_beside) {
        write_pictures(path, built, json, progress);
        built.parts.resize(built.geometry_parts);
    }
    if (extension == "glb")
        write_glb(path, json, built.parts, progress);
    else
        write_json(path, json, built.parts, progress);
}

}  // namespace treerec
