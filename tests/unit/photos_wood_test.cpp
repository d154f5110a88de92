// From photos to a cloud that says how thick the wood is: pipeline/photos.h, with a program that stands
// in for COLMAP and photos of a drawn stem.
#include <gtest/gtest.h>

#include "drawn_bark.h"
#include "exchange/material_textures.h"
#include "geometry/parallel.h"
#include "geometry/quantile.h"
#include "photos_standin.h"
#include "pipeline/photos.h"
#include "scan/formats/read_cloud.h"

namespace treerec {
namespace {

namespace fs = std::filesystem;
using test::InFolder;
using test::WithStandIn;

constexpr double kThick = 0.15, kThinner = 0.08;  // the stem of write_tiny_model(), z down: of all its height
constexpr double kGround = 1.0, kTall = 2.5;

double radius_at(double z) {
    return kThick - kThinner * (kGround - z) / kTall;
}

// What write_tiny_model()'s photos show of its stem, before the sky.
class PhotosOfWood : public WithStandIn<InFolder> {
  protected:
    void SetUp() override {
        WithStandIn<InFolder>::SetUp();
        if (IsSkipped()) return;
        std::vector<std::string> names;
        for (int i = 0; i < 24; i++)
            names.push_back("photo" + std::to_string(10 + i) + ".png");
        take_photos(names);
        for (size_t i = 0; i < names.size(); i++)
            put("photos/" + names[i], picture(2.0 * kPi * static_cast<double>(i) / 24.0));
    }

    static std::string picture(double angle) {
        const DVec3 centre(4.0 * std::cos(angle), 4.0 * std::sin(angle), 0.0), down(0.0, 0.0, 1.0);
        const DVec3 ahead = -glm::normalize(centre), right = glm::cross(down, ahead);
        Image picture(640, 480, 3);
        parallel_for(480, 16, [&](size_t begin, size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); y++)
                for (int x = 0; x < 640; x++) {
                    DVec3 sum(0.0);
                    for (const double v : {0.25, 0.75})
                        for (const double u : {0.25, 0.75})
                            sum += seen_along(centre, (x + u - 320.0) / 500.0 * right +
                                                          (y + v - 240.0) / 500.0 * down + ahead);
                    for (int c = 0; c < 3; c++)
                        picture.at(x, y)[c] = texture::to_byte(sum[c] / 4.0);
                }
        });
        const std::vector<uint8_t> bytes = encode_png(picture);
        return {bytes.begin(), bytes.end()};
    }

    static DVec3 seen_along(const DVec3& from, const DVec3& way) {
        // Of x² + y² = (base + slope z)², all of it to the sky.
        const double slope = kThinner / kTall, base = radius_at(0.0);
        const double a = way.x * way.x + way.y * way.y - slope * slope * way.z * way.z;
        const double b = from.x * way.x + from.y * way.y - slope * way.z * (base + slope * from.z);
        const double c = from.x * from.x + from.y * from.y - std::pow(base + slope * from.z, 2);
        const double root = b * b - a * c;
        if (root > 0.0) {
            const DVec3 p = from + way * ((-b - std::sqrt(root)) / a);
            if (p.z < kGround && p.z > kGround - kTall) return test::bark_at({p.x, -p.z, p.y});
        }
        return {0.55, 0.7, 0.9};
    }

    PhotosResult made() const {
        PhotosOptions options;
        options.cloud.densify.megapixels = 0.1;
        options.cloud.densify.neighbours = 2;
        options.reconstruct.orient.metres_per_unit = 1.0;
        options.bark = options.leaf_colours = false;
        return reconstruct_photos(path("photos"), path("out"), options);
    }
};

TEST_F(PhotosOfWood, TheCloudSaysHowThickItIsAndTheNextRunKnowsIt) {
    const PhotosResult first = made();
    ASSERT_GT(first.made.pairs, 0U) << (first.made.warnings.empty() ? "" : first.made.warnings[0]);
    EXPECT_GT(first.made.outlines, 5U);
    const PointCloud cloud = read_cloud(first.cloud);
    ASSERT_EQ(cloud.radii.size(), cloud.size());
    std::vector<float> off;
    for (size_t i = 0; i < cloud.size(); i++)
        if (const double z = cloud.frame.to_scan(DVec3(cloud.positions[i])).z;
            cloud.radii[i] > 0.0F && z < 0.8 && z > -1.2)
            off.push_back(static_cast<float>(std::abs(cloud.radii[i] / radius_at(z) - 1.0)));
    EXPECT_GT(off.size(), cloud.size() / 2);
    EXPECT_LT(quantile(off, 0.5), 0.04F);
    // The note of the cloud is all that is left of the work when the tree alone is made again.
    const std::string bytes = get("out/cloud.ply");
    const auto written = fs::last_write_time(path("out/cloud.ply"));
    const PhotosResult again = made();
    EXPECT_EQ(again.made.outlines, first.made.outlines);
    EXPECT_EQ(again.made.pairs, first.made.pairs);
    EXPECT_EQ(again.made.points, first.made.points);
    EXPECT_EQ(fs::last_write_time(path("out/cloud.ply")), written);
    EXPECT_EQ(get("out/cloud.ply"), bytes);
    EXPECT_EQ(again.tree.tree.size(), first.tree.tree.size());
}

}  // namespace
}  // namespace treerec
