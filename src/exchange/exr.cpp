#include "exchange/exr.h"

#include <bit>
#include <cstdint>
#include <string_view>

namespace treerec {

namespace {

class Writer {
  public:
    template <typename T>
    void put(T value) {
        auto bits = static_cast<uint64_t>(value);
        for (size_t k = 0; k < sizeof(T); k++, bits >>= 8)
            bytes_ += static_cast<char>(bits & 0xFF);
    }
    void put_float(float value) { put(std::bit_cast<uint32_t>(value)); }
    void put_name(std::string_view name) { bytes_.append(name).push_back('\0'); }
    void attribute(std::string_view name, std::string_view type, uint32_t size) {
        put_name(name);
        put_name(type);
        put(size);
    }
    void reserve(size_t size) { bytes_.reserve(size); }
    size_t size() const { return bytes_.size(); }
    std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

void put_header(Writer& writer, uint32_t width, uint32_t height) {
    writer.put(uint32_t{20000630});  // the magic number
    writer.put(uint32_t{2});         // version 2: one part, scan lines
    writer.attribute("channels", "chlist", 19);
    writer.put_name("R");
    writer.put(uint32_t{2});  // 32-bit float
    writer.put(uint32_t{0});  // not perceptually linear, and three bytes to spare
    writer.put(uint32_t{1});  // every pixel along x, along y
    writer.put(uint32_t{1});
    writer.put(uint8_t{0});
    writer.attribute("compression", "compression", 1);
    writer.put(uint8_t{0});
    for (const char* window : {"dataWindow", "displayWindow"}) {
        writer.attribute(window, "box2i", 16);
        for (const uint32_t edge : {0U, 0U, width - 1, height - 1})
            writer.put(edge);
    }
    writer.attribute("lineOrder", "lineOrder", 1);
    writer.put(uint8_t{0});
    writer.attribute("pixelAspectRatio", "float", 4);
    writer.put_float(1.0F);
    writer.attribute("screenWindowCenter", "v2f", 8);
    writer.put_float(0.0F);
    writer.put_float(0.0F);
    writer.attribute("screenWindowWidth", "float", 4);
    writer.put_float(1.0F);
    writer.put(uint8_t{0});
}

}  // namespace

std::string exr_bytes(size_t width, size_t height, std::span<const float> values) {
    Writer writer;
    const size_t row = 4 * width;
    writer.reserve(400 + height * (row + 16));
    put_header(writer, static_cast<uint32_t>(width), static_cast<uint32_t>(height));
    const uint64_t first = writer.size() + 8 * height;
    for (size_t y = 0; y < height; y++)
        writer.put(first + y * (row + 8));
    for (size_t y = 0; y < height; y++) {
        writer.put(static_cast<uint32_t>(y));
        writer.put(static_cast<uint32_t>(row));
        for (size_t x = 0; x < width; x++)
            writer.put_float(values[y * width + x]);
    }
    return writer.take();
}

}  // namespace treerec
