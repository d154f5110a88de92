#include "exchange/read_triangles.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>

#include "edit/commands/command_text.h"
#include "error.h"
#include "exchange/quiet_tiny_gltf.h"
#include "file_bytes.h"

namespace treerec {

namespace {

using Triangles = std::vector<std::array<DVec3, 3>>;

constexpr int kDeepest = 64;  // nodes below one another
constexpr size_t kMostTriangles = 5000000;

[[noreturn]] void refuse(const std::string& path, size_t line, const std::string& why) {
    throw Error("'" + path + "', line " + std::to_string(line) + ": " + why);
}

Triangles read_obj(const std::string& path, const FileBytes& bytes) {
    std::vector<DVec3> points;
    Triangles triangles;
    size_t number = 0;
    for (std::string_view line : split(bytes.view(), '\n')) {
        number++;
        std::vector<std::string_view> words;
        for (const std::string_view word : split(line, ' '))
            if (!word.empty() && word != "\r") words.push_back(word.substr(0, word.find('\r')));
        if (words.empty()) continue;
        if (words[0] == "v") {
            DVec3 point(0.0);
            for (size_t i = 0; i < 3; i++) {
                const std::optional<double> value =
                    i + 1 < words.size() ? read_number(words[i + 1]) : std::nullopt;
                if (!value) refuse(path, number, "a point takes three numbers.");
                point[static_cast<int>(i)] = *value;
            }
            points.push_back(point);
        } else if (words[0] == "f") {
            std::vector<DVec3> corners;
            for (size_t i = 1; i < words.size(); i++) {
                const std::optional<double> index = read_number(words[i].substr(0, words[i].find('/')));
                const double count = static_cast<double>(points.size());
                const double at = !index ? 0.0 : *index < 0.0 ? count + *index + 1.0 : *index;
                if (!(at >= 1.0 && at <= count))
                    refuse(path, number, "a face names a point that is not there.");
                corners.push_back(points[static_cast<size_t>(at) - 1]);
            }
            for (size_t i = 2; i < corners.size(); i++)
                triangles.push_back({corners[0], corners[i - 1], corners[i]});
        }
    }
    if (triangles.empty())
        throw Error("'" + path + "' has no faces: give a mesh as a .glb, .gltf or .obj file.");
    return triangles;
}

// The scene of a glTF model as triangles. What the file says is believed only as far as its buffers reach.
class SceneReader {
  public:
    SceneReader(const std::string& path, const tinygltf::Model& model) : path_(path), model_(model) {}

    Triangles read() {
        if (model_.scenes.empty()) {
            for (size_t i = 0; i < model_.meshes.size(); i++)
                add_mesh(static_cast<int>(i), DMat4(1.0));
        } else {
            const int scene = std::max(model_.defaultScene, 0);
            for (const int node : at(model_.scenes, scene).nodes)
                add_node(node, DMat4(1.0), 0);
        }
        return std::move(triangles_);
    }

  private:
    using DMat4 = glm::dmat4;

    // Where an accessor's elements lie.
    struct View {
        const unsigned char* bytes;
        size_t count, stride;
    };

    [[noreturn]] void damaged() const {
        throw Error("'" + path_ + "' names what is not in it: the file is damaged.");
    }

    template <typename T>
    const T& at(const std::vector<T>& all, int index) const {
        if (index < 0 || static_cast<size_t>(index) >= all.size()) damaged();
        return all[static_cast<size_t>(index)];
    }

    View view_of(const tinygltf::Accessor& accessor) const {
        if (accessor.sparse.isSparse || accessor.bufferView < 0)
            throw Error("'" + path_ + "' has sparse or compressed geometry: export it without compression.");
        const tinygltf::BufferView& view = at(model_.bufferViews, accessor.bufferView);
        const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer);
        const int stride = accessor.ByteStride(view);
        const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
                         tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
        if (stride <= 0 || size <= 0) damaged();
        const size_t count = accessor.count, step = static_cast<size_t>(stride);
        const size_t length = std::min(view.byteLength, buffer.data.size());
        if (view.byteOffset > buffer.data.size() || length > buffer.data.size() - view.byteOffset ||
            accessor.byteOffset > length || count > length ||
            (count > 0 && (count - 1) * step + static_cast<size_t>(size) > length - accessor.byteOffset))
            damaged();
        return {buffer.data.data() + view.byteOffset + accessor.byteOffset, count, step};
    }

    template <typename T>
    static T number_at(const unsigned char* bytes) {
        T value;
        std::memcpy(&value, bytes, sizeof(T));
        return value;
    }

    std::vector<size_t> corners_of(const tinygltf::Primitive& primitive, size_t count) const {
        std::vector<size_t> corners;
        if (primitive.indices < 0) {
            for (size_t i = 0; i < count; i++)
                corners.push_back(i);
            return corners;
        }
        const tinygltf::Accessor& accessor = at(model_.accessors, primitive.indices);
        const View view = view_of(accessor);
        corners.reserve(view.count);
        for (size_t i = 0; i < view.count; i++) {
            const unsigned char* const bytes = view.bytes + i * view.stride;
            size_t corner = count;
            if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) corner = *bytes;
            if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
                corner = number_at<uint16_t>(bytes);
            if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
                corner = number_at<uint32_t>(bytes);
            if (corner >= count) damaged();
            corners.push_back(corner);
        }
        return corners;
    }

    void add_mesh(int index, const DMat4& to) {
        for (const tinygltf::Primitive& primitive : at(model_.meshes, index).primitives) {
            if (primitive.extensions.contains("KHR_draco_mesh_compression"))
                throw Error("'" + path_ +
                            "' has sparse or compressed geometry: export it without compression.");
            const auto places = primitive.attributes.find("POSITION");
            if (places == primitive.attributes.end()) continue;
            const tinygltf::Accessor& accessor = at(model_.accessors, places->second);
            if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT ||
                accessor.type != TINYGLTF_TYPE_VEC3)
                throw Error("'" + path_ +
                            "' has sparse or compressed geometry: export it without compression.");
            const View view = view_of(accessor);
            std::vector<DVec3> points;
            points.reserve(view.count);
            for (size_t i = 0; i < view.count; i++) {
                const unsigned char* const bytes = view.bytes + i * view.stride;
                const DVec3 p(number_at<float>(bytes), number_at<float>(bytes + 4),
                              number_at<float>(bytes + 8));
                points.emplace_back(to * glm::dvec4(p, 1.0));
            }
            const std::vector<size_t> corners = corners_of(primitive, points.size());
            const bool mirrored = glm::determinant(glm::dmat3(to)) < 0.0;
            const auto add = [&](size_t a, size_t b, size_t c) {
                if (triangles_.size() >= kMostTriangles)
                    throw Error("'" + path_ + "' has more than " + std::to_string(kMostTriangles) +
                                " triangles: simplify it.");
                if (mirrored) std::swap(b, c);
                triangles_.push_back({points[a], points[b], points[c]});
            };
            const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
            if (mode == TINYGLTF_MODE_TRIANGLES)
                for (size_t i = 0; i + 2 < corners.size(); i += 3)
                    add(corners[i], corners[i + 1], corners[i + 2]);
            if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
                for (size_t i = 0; i + 2 < corners.size(); i++)
                    add(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
            if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
                for (size_t i = 1; i + 1 < corners.size(); i++)
                    add(corners[0], corners[i], corners[i + 1]);
        }
    }

    static DMat4 own_of(const tinygltf::Node& node) {
        DMat4 own(1.0);
        if (node.matrix.size() == 16) {
            for (int i = 0; i < 16; i++)
                own[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
            return own;
        }
        if (node.rotation.size() == 4) {
            const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2],
                         w = node.rotation[3];
            own[0] =
                glm::dvec4(1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + z * w), 2.0 * (x * z - y * w), 0.0);
            own[1] =
                glm::dvec4(2.0 * (x * y - z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + x * w), 0.0);
            own[2] =
                glm::dvec4(2.0 * (x * z + y * w), 2.0 * (y * z - x * w), 1.0 - 2.0 * (x * x + y * y), 0.0);
        }
        for (int i = 0; i < 3; i++) {
            if (node.scale.size() == 3) own[i] *= node.scale[static_cast<size_t>(i)];
            if (node.translation.size() == 3) own[3][i] = node.translation[static_cast<size_t>(i)];
        }
        return own;
    }

    void add_node(int index, const DMat4& parent, int depth) {
        if (depth > kDeepest || ++visited_ > model_.nodes.size()) damaged();  // a node below itself
        const tinygltf::Node& node = at(model_.nodes, index);
        const DMat4 to = parent * own_of(node);
        if (node.mesh >= 0) add_mesh(node.mesh, to);
        for (const int child : node.children)
            add_node(child, to, depth + 1);
    }

    const std::string& path_;
    const tinygltf::Model& model_;
    Triangles triangles_;
    size_t visited_ = 0;
};

// Of the path as it was given, UTF-8, on every system, as the callbacks below take it: a filesystem path's
// string() is in the code page on Windows.
std::string folder_of(const std::string& path) {
    const bool windows = std::filesystem::path::preferred_separator == '\\';
    const size_t slash = path.find_last_of(windows ? "/\\" : "/");
    return slash == std::string::npos ? "" : path.substr(0, slash + 1);
}

tinygltf::Model parse(const std::string& path, const FileBytes& bytes) {
    tinygltf::TinyGLTF reader;
    // Pictures don't matter, and no name is given to a shell.
    reader.SetImageLoader([](tinygltf::Image*, const int, std::string*, std::string*, int, int,
                             const unsigned char*, int, void*) { return true; },
                          nullptr);
    reader.SetFsCallbacks(
        {[](const std::string& name, void*) { return std::filesystem::is_regular_file(path_of(name)); },
         [](const std::string& name, void*) { return name; },
         [](std::vector<unsigned char>* out, std::string* error, const std::string& name, void*) {
             try {
                 const FileBytes bytes = read_file(name);
                 const std::string_view content = bytes.view();
                 out->assign(content.begin(), content.end());
                 return true;
             } catch (const Error& why) {
                 *error = why.what();
                 return false;
             }
         },
         [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; },
         nullptr});
    const std::string_view text = bytes.view();
    if (text.size() > UINT32_MAX) throw Error("'" + path + "' is larger than 4 GB: simplify it.");
    const auto size = static_cast<unsigned int>(text.size());
    const std::string folder = folder_of(path);
    tinygltf::Model model;
    std::string error, warning;
    bool good = false;
    try {
        good = text.starts_with("glTF")
                   ? reader.LoadBinaryFromMemory(&model, &error, &warning,
                                                 reinterpret_cast<const unsigned char*>(text.data()), size,
                                                 folder)
                   : reader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, folder);
    } catch (const std::exception& why) {  // of its JSON
        error = why.what();
    }
    if (!good) {
        const std::string first = error.substr(0, error.find('\n'));
        throw Error("'" + path + "' can't be read as a glTF model" + (first.empty() ? "." : ": " + first));
    }
    return model;
}

}  // namespace

std::vector<std::array<DVec3, 3>> read_triangles(const std::string& path) {
    const FileBytes bytes = read_file(path);
    const std::string extension = extension_of(path);
    if (extension != "glb" && extension != "gltf") return read_obj(path, bytes);
    Triangles triangles = SceneReader(path, parse(path, bytes)).read();
    if (triangles.empty()) throw Error("'" + path + "' shows no triangles in its scene.");
    return triangles;
}

}  // namespace treerec
