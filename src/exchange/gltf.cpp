#include "exchange/gltf.h"

#include <algorithm>
#include <cstring>
#include <sstream>

#include "error.h"
#include "file_bytes.h"

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#endif
#include <tiny_gltf.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace treerec {

namespace {

constexpr size_t kLargestFile = 0xFFFFFF00;  // a .glb counts its bytes in 32 bits

// Appends to the model's one buffer.
class Builder {
  public:
    explicit Builder(tinygltf::Model& model) : model_(model) { model_.buffers.resize(1); }

    int add_view(const void* bytes, size_t size, int target) {
        std::vector<unsigned char>& data = model_.buffers[0].data;
        data.resize((data.size() + 3) / 4 * 4, 0);
        if (data.size() + size > kLargestFile)
            throw Error("The model is larger than 4 GB; simplify the tree or write fewer leaves.");
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = data.size();
        view.byteLength = size;
        view.target = target;
        const auto* first = static_cast<const unsigned char*>(bytes);
        data.insert(data.end(), first, first + size);
        model_.bufferViews.push_back(std::move(view));
        return static_cast<int>(model_.bufferViews.size()) - 1;
    }

    template <typename T>
    int add_accessor(const std::vector<T>& values, int component, int type, int target) {
        tinygltf::Accessor accessor;
        accessor.bufferView = add_view(values.data(), values.size() * sizeof(T), target);
        accessor.componentType = component;
        accessor.type = type;
        accessor.count = values.size();
        accessor.normalized = component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    int add_mesh(const Mesh& mesh, const char* name, int material) {
        constexpr int kVertices = TINYGLTF_TARGET_ARRAY_BUFFER, kFloat = TINYGLTF_COMPONENT_TYPE_FLOAT;
        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = material;
        primitive.indices = add_accessor(mesh.indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                         TINYGLTF_TYPE_SCALAR, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
        auto& attributes = primitive.attributes;
        attributes["POSITION"] = add_accessor(mesh.positions, kFloat, TINYGLTF_TYPE_VEC3, kVertices);
        Vec3 low = mesh.positions[0], high = low;
        for (const Vec3& position : mesh.positions) {
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
        model_.accessors.back().minValues = {low.x, low.y, low.z};
        model_.accessors.back().maxValues = {high.x, high.y, high.z};
        attributes["NORMAL"] = add_accessor(mesh.normals, kFloat, TINYGLTF_TYPE_VEC3, kVertices);
        attributes["TANGENT"] = add_accessor(mesh.tangents, kFloat, TINYGLTF_TYPE_VEC4, kVertices);
        attributes["TEXCOORD_0"] = add_accessor(mesh.uvs, kFloat, TINYGLTF_TYPE_VEC2, kVertices);
        std::vector<glm::u8vec4> wind(mesh.colors.size());
        for (size_t i = 0; i < wind.size(); i++)
            wind[i] = glm::u8vec4(glm::clamp(mesh.colors[i], 0.0f, 1.0f) * 255.0f + 0.5f);
        attributes["_WIND"] =
            add_accessor(wind, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4, kVertices);
        tinygltf::Mesh made;
        made.name = name;
        made.primitives.push_back(std::move(primitive));
        model_.meshes.push_back(std::move(made));
        return static_cast<int>(model_.meshes.size()) - 1;
    }

    int add_texture(const std::vector<NamedPicture>& pictures, const std::string& name, int wrap) {
        const auto found = std::find_if(pictures.begin(), pictures.end(),
                                        [&](const NamedPicture& picture) { return picture.name == name; });
        if (found == pictures.end()) throw Error("The model lacks the picture '" + name + "'.");
        tinygltf::Image image;
        image.name = name;
        image.mimeType = "image/png";
        image.bufferView = add_view(found->png.data(), found->png.size(), 0);
        tinygltf::Sampler sampler;
        sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
        sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
        sampler.wrapS = sampler.wrapT = wrap;
        tinygltf::Texture texture;
        texture.name = name;
        texture.source = static_cast<int>(model_.images.size());
        const auto same = std::find_if(model_.samplers.begin(), model_.samplers.end(),
                                       [&](const tinygltf::Sampler& other) { return other.wrapS == wrap; });
        texture.sampler = static_cast<int>(same - model_.samplers.begin());
        if (same == model_.samplers.end()) model_.samplers.push_back(sampler);
        model_.images.push_back(std::move(image));
        model_.textures.push_back(std::move(texture));
        return static_cast<int>(model_.textures.size()) - 1;
    }

  private:
    tinygltf::Model& model_;
};

bool drawn(const Mesh* mesh) {
    return mesh && !mesh->indices.empty();
}

tinygltf::Model build(const ModelFile& file) {
    tinygltf::Model model;
    Builder builder(model);
    model.asset.version = "2.0";
    model.asset.generator = "Godot tree reconstruction (treerec)";
    tinygltf::Node tree;
    tree.name = "Tree";
    tinygltf::Value::Object extras;
    for (const auto& [name, value] : file.extras)
        extras[name] = tinygltf::Value(value);
    if (!extras.empty()) tree.extras = tinygltf::Value(extras);
    std::vector<tinygltf::Node> parts;
    const auto add_part = [&](const char* name, int mesh) {
        tinygltf::Node part;
        part.name = name;
        part.mesh = mesh;
        parts.push_back(std::move(part));
        tree.children.push_back(static_cast<int>(parts.size()));
    };
    // Geometry first: the pictures at the buffer's end can then be cut off into files of their own.
    int bark_material = 0, leaf_material = drawn(file.bark) ? 1 : 0;
    if (drawn(file.bark)) add_part("Bark", builder.add_mesh(*file.bark, "Bark", bark_material));
    if (drawn(file.leaves)) add_part("Leaves", builder.add_mesh(*file.leaves, "Leaves", leaf_material));
    const std::vector<NamedPicture> made = file.pictures.empty() && !parts.empty()
                                               ? make_pictures(file.preset, kTextureSize, file.texture_seed)
                                               : std::vector<NamedPicture>();
    const std::vector<NamedPicture>& pictures = file.pictures.empty() ? made : file.pictures;
    if (drawn(file.bark)) {
        tinygltf::Material material;
        material.name = "bark";
        auto& surface = material.pbrMetallicRoughness;
        surface.baseColorTexture.index =
            builder.add_texture(pictures, "bark_albedo", TINYGLTF_TEXTURE_WRAP_REPEAT);
        material.normalTexture.index =
            builder.add_texture(pictures, "bark_normal", TINYGLTF_TEXTURE_WRAP_REPEAT);
        surface.metallicRoughnessTexture.index =
            builder.add_texture(pictures, "bark_roughness", TINYGLTF_TEXTURE_WRAP_REPEAT);
        material.occlusionTexture.index = surface.metallicRoughnessTexture.index;
        model.materials.push_back(std::move(material));
    }
    if (drawn(file.leaves)) {
        tinygltf::Material material;
        material.name = "leaves";
        material.alphaMode = "MASK";
        material.alphaCutoff = 0.4;
        material.doubleSided = true;
        auto& surface = material.pbrMetallicRoughness;
        surface.metallicFactor = 0.0;
        surface.roughnessFactor = 0.7;
        surface.baseColorTexture.index =
            builder.add_texture(pictures, "leaf_albedo", TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE);
        material.normalTexture.index =
            builder.add_texture(pictures, "leaf_normal", TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE);
        model.materials.push_back(std::move(material));
    }
    model.nodes.push_back(std::move(tree));
    for (tinygltf::Node& part : parts)
        model.nodes.push_back(std::move(part));
    tinygltf::Scene scene;
    scene.name = "Tree";
    scene.nodes = {0};
    model.scenes.push_back(std::move(scene));
    model.defaultScene = 0;
    if (model.buffers[0].data.empty()) model.buffers.clear();
    return model;
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

uint32_t read_u32(const std::string& bytes, size_t at) {
    uint32_t value = 0;
    for (size_t i = 0; i < 4; i++)
        value |= static_cast<uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
    return value;
}

// The one-file form taken apart: JSON, buffer and pictures, each in a file, the JSON last.
void write_parts(const std::string& path, const std::string& glb) {
    const std::string stem = stem_of(path);
    const size_t json_size = read_u32(glb, 12);
    nlohmann::json json = nlohmann::json::parse(glb.substr(20, json_size));
    if (json.contains("buffers")) {
        const char* bytes = glb.data() + 20 + json_size + 8;
        size_t geometry = json["buffers"][0]["byteLength"].get<size_t>();
        for (auto& image : json["images"]) {
            const auto& view = json["bufferViews"][image["bufferView"].get<size_t>()];
            const size_t offset = view.value("byteOffset", size_t{0});
            const std::string name = stem + "_" + image["name"].get<std::string>() + ".png";
            write_file(sibling_of(path, name), {bytes + offset, view["byteLength"].get<size_t>()});
            geometry = std::min(geometry, offset);
            image.erase("bufferView");
            image.erase("mimeType");
            image["uri"] = percent_encoded(name);
        }
        auto& views = json["bufferViews"];
        views.erase(views.end() - static_cast<std::ptrdiff_t>(json["images"].size()), views.end());
        write_file(sibling_of(path, stem + ".bin"), {bytes, geometry});
        json["buffers"][0] = {{"byteLength", geometry}, {"uri", percent_encoded(stem + ".bin")}};
    }
    write_file(path, json.dump(1, '\t'));
}

}  // namespace

void write_gltf(const std::string& path, const ModelFile& file) {
    const std::string extension = extension_of(path);
    if (extension != "glb" && extension != "gltf") throw Error("'" + path + "' must end in .glb or .gltf.");
    const tinygltf::Model model = build(file);
    std::ostringstream stream;
    if (!tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true))
        throw Error("Cannot put together the glTF model for '" + path + "'.");
    const std::string glb = std::move(stream).str();
    if (extension == "glb")
        write_file(path, glb);
    else
        write_parts(path, glb);
}

}  // namespace treerec
