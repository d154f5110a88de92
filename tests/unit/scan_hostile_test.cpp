// Damaged files: an Error or a sound cloud, nothing else. Meant to be run with sanitizers too.
#include "scan/cleaning/clean_cloud.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using namespace scan_test;

struct Sample {
    std::string name;
    std::string bytes;
};

// One valid file of every kind.
std::vector<Sample> valid_files() {
    const Folder folder;
    std::vector<Sample> files;
    const PointCloud cloud = random_cloud(21, 40, {455123.4, -312.0, 6.0}, 5.0, true, true);
    for (const char* name : {"a.ply", "a.las", "a.txt"}) {
        write_cloud(folder.file(name), cloud);
        files.push_back({name, bytes_of(folder.file(name))});
    }
    files.push_back(
        {"b.ply",
         "ply\nformat ascii 1.0\nelement camera 1\nproperty list uchar float k\nelement vertex 4\n"
         "property double x\nproperty list uchar int ids\nproperty float y\nproperty float z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
         "end_header\n2 1 2\n1 0 2 3 9 9 9 1\n2 1 7 2 3 8 8 8 1\n3 0 1 1 7 7 7 1\n4 2 1 1 5 5 6 6 6 1\n"});
    std::string list_ply =
        "ply\nformat binary_big_endian 1.0\nelement vertex 6\nproperty float x\nproperty list uchar short "
        "ids\n"
        "property float y\nproperty float z\nelement face 0\nproperty list uchar int v\nend_header\n";
    for (int i = 0; i < 6; i++)
        list_ply += std::string("\x3F\x80\0\0\x02\0\x07\0\x08\x40\0\0\0\x40\x40\0\0", 17);
    files.push_back({"c.ply", list_ply});
    files.push_back(
        {"b.pts", "5\n1 2 3 -7 10 20 30\n4 5 6 -8 40 50 60\n7 8 9 1 1 2 3\n1 1 1 1 4 5 6\n2 2 2 2 9 9 9\n"});
    files.push_back(
        {"c.csv", "\"x\";\"y\";\"z\";\"name\"\n1,5;2,5;3,5;oak\n4,5;5,5;6,5;elm\n7,5;8,5;9,5;yew\n"});
    return files;
}

// Reads, and where that works orients and cleans too. Returns the number of points, 0 for an Error.
size_t read_all(const Folder& folder, const Sample& file, const std::string& bytes) {
    const std::string path = folder.write(file.name, bytes);
    PointCloud cloud;
    try {
        cloud = read_cloud(path);
    } catch (const Error& error) {
        EXPECT_FALSE(std::string(error.what()).empty());
        return 0;
    }
    EXPECT_FALSE(cloud.empty());
    EXPECT_TRUE(cloud.colors.empty() || cloud.colors.size() == cloud.size());
    EXPECT_TRUE(cloud.normals.empty() || cloud.normals.size() == cloud.size());
    const size_t count = cloud.size();
    orient_cloud(cloud, {});
    clean_cloud(cloud, {});
    EXPECT_FALSE(cloud.empty());
    for (const Vec3& p : cloud.positions)
        EXPECT_TRUE(is_finite(DVec3(p)));
    for (const Vec3& n : cloud.normals)
        EXPECT_TRUE(is_finite(DVec3(n)));
    return count;
}

TEST(ScanHostile, TruncatedAnywhere) {
    const Folder folder;
    for (const Sample& file : valid_files()) {
        SCOPED_TRACE(file.name);
        const size_t whole = read_all(folder, file, file.bytes);
        ASSERT_GT(whole, 0U);
        // Binary files and files with a count of points cannot be cut without notice.
        const bool counted = file.name != "a.txt" && file.name != "c.csv";
        for (size_t size = 0; size < file.bytes.size(); size += 7) {
            const size_t count = read_all(folder, file, file.bytes.substr(0, size));
            if (counted && count > 0) {
                EXPECT_EQ(count, whole) << size;
            }
        }
    }
}

TEST(ScanHostile, FlippedBytes) {
    const Folder folder;
    Random random(22);
    const std::vector<Sample> files = valid_files();
    for (int round = 0; round < 2000; round++) {
        const Sample& file = files[random.below(static_cast<uint32_t>(files.size()))];
        std::string bytes = file.bytes;
        // Half of the rounds aim at the header.
        const uint32_t reach =
            static_cast<uint32_t>(random.below(2) ? std::min<size_t>(400, bytes.size()) : bytes.size());
        for (uint32_t flips = 1 + random.below(8); flips > 0; flips--)
            bytes[random.below(reach)] = static_cast<char>(random.below(256));
        SCOPED_TRACE(file.name + " " + std::to_string(round));
        read_all(folder, file, bytes);
    }
}

TEST(ScanHostile, DigitsReplaced) {
    const Folder folder;
    Random random(23);
    const std::vector<Sample> files = valid_files();
    const char* const numbers[] = {"-1",    "0",   "4294967296", "18446744073709551615",
                                   "1e400", "nan", "-inf",       "0x7f"};
    for (int round = 0; round < 1000; round++) {
        const Sample& file = files[random.below(static_cast<uint32_t>(files.size()))];
        std::string bytes = file.bytes;
        const size_t at =
            bytes.find_first_of("0123456789", random.below(static_cast<uint32_t>(bytes.size())));
        if (at == bytes.npos) continue;
        bytes.replace(at, 1, numbers[random.below(8)]);
        SCOPED_TRACE(file.name + " " + std::to_string(round));
        read_all(folder, file, bytes);
    }
}

TEST(ScanHostile, Garbage) {
    const Folder folder;
    Random random(24);
    for (int round = 0; round < 300; round++) {
        std::string bytes;
        const bool text = round % 3 == 0;
        for (uint32_t size = random.below(3000); size > 0; size--)
            bytes +=
                text ? "0123456789.,;- \n\te\"#xyz"[random.below(23)] : static_cast<char>(random.below(256));
        for (const char* start : {"", "ply\n", "LASF"}) {
            SCOPED_TRACE(std::to_string(round) + start);
            read_all(folder, {"a.xyz", ""}, start + bytes);
        }
    }
}

}  // namespace
}  // namespace treerec
