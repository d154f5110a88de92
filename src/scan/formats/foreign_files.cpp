// What people open by mistake, and what to do instead.
#include <cstring>

#include "scan/formats/readers.h"

namespace treerec {

namespace {

struct Known {
    std::string_view mark;  // the first bytes, or the extension
    const char* what;
};

constexpr Known kMagic[] = {
    {"\xFF\xD8\xFF", "a JPEG picture, not a point cloud"},
    {"\x89PNG", "a PNG picture, not a point cloud"},
    {"GIF8", "a GIF picture, not a point cloud"},
    {"II*\0", "a TIFF picture, not a point cloud"},
    {"MM\0*", "a TIFF picture, not a point cloud"},
    {"RIFF", "a picture, a sound or a film, not a point cloud"},
    {"%PDF", "a PDF document, not a point cloud"},
    {"glTF", "a glTF model, not a point cloud"},
    {"BLENDER", "a Blender file, not a point cloud"},
    {"Kaydara FBX", "an FBX model, not a point cloud"},
    {"DRACO", "a Draco model, which is not read; save it as PLY"},
    {"PXR-USDC", "a USD model, not a point cloud"},
    {"#usda", "a USD model, not a point cloud"},
    {"solid ", "an STL model, not a point cloud"},
    {"OFF\n", "an OFF model, which is not read; save it as PLY"},
    {"[gd_", "a Godot scene or resource, not a point cloud"},
    {"RSRC", "a Godot resource, not a point cloud"},
    {"RSCC", "a Godot resource, not a point cloud"},
    {"PK\x03\x04", "a ZIP archive; unpack it and open the point cloud in it"},
    {"Rar!", "a RAR archive; unpack it and open the point cloud in it"},
    {"7z\xBC\xAF", "a 7-Zip archive; unpack it and open the point cloud in it"},
    {"\x1F\x8B", "compressed by gzip; unpack it first"},
    {"BZh", "compressed by bzip2; unpack it first"},
    {"\xFD"
     "7zXZ",
     "compressed by xz; unpack it first"},
    {"\x28\xB5\x2F\xFD", "compressed by zstd; unpack it first"},
    {"ASTM-E57", "an E57 file, which is not read; convert it to LAS or PLY, for example in CloudCompare"},
    {"CCB2", "a CloudCompare project; save the cloud as PLY or LAS there"},
    {"#ROSBAG", "a ROS recording, which is not read; save its cloud as PCD"},
    {"\x93NUMPY", "a NumPy array, which is not read; save it as text"},
    {"\x89HDF", "an HDF5 file, which is not read"},
    {"PAR1", "a Parquet table, which is not read; save it as CSV"},
    {"SQLite format 3", "a database (COLMAP's?), not a point cloud; choose COLMAP's points3D.bin"},
    {"# Camera list with", "COLMAP's list of cameras; choose points3D.txt beside it"},
    {"# Image list with", "COLMAP's list of images; choose points3D.txt beside it"},
    {"<", "a web page or XML document, not a point cloud"},
    {"{", "a JSON document (such as glTF), not a point cloud"},
    {"\xFF\xFE", "text in UTF-16; save it as UTF-8"},
    {"\xFE\xFF", "text in UTF-16; save it as UTF-8"},
};

// Nothing in these files says what they are.
constexpr Known kExtensions[] = {
    {"splat", "a Gaussian splat file in the form .splat, which is not read; export it as PLY"},
    {"ksplat", "a Gaussian splat file in the form .ksplat, which is not read; export it as PLY"},
    {"spz", "a Gaussian splat file in the form .spz, which is not read; export it as PLY"},
    {"sog", "a Gaussian splat file in the form .sog, which is not read; export it as PLY"},
    {"stl", "an STL model, not a point cloud"},
    {"obj", "an OBJ model, not a point cloud; save its points as PLY"},
    {"ptx", "a PTX scan, which is not read; save it as PTS or LAS"},
    {"fls", "a FARO scan, which is not read; export it as LAS or PTS"},
    {"rxp", "a RIEGL scan, which is not read; export it as LAS"},
    {"rcp", "a ReCap project, which is not read; export it as PTS or E57 and convert that to LAS"},
    {"psx", "a Metashape project; export its point cloud as PLY or LAS"},
};

}  // namespace

std::string foreign_kind(std::string_view bytes, const std::string& extension) {
    for (const Known& known : kExtensions)
        if (extension == known.mark) return known.what;
    for (const Known& known : kMagic)
        if (bytes.starts_with(known.mark)) return known.what;
    if (bytes.size() > 8 && bytes.substr(4, 4) == "ftyp")
        return "a picture or film (HEIC, MP4), not a point cloud";
    return {};
}

}  // namespace treerec
