// LAS files that say how long a unit is, which points are noise, and which are leaves.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "scan/cleaning/clean_cloud.h"
#include "scan/formats/las_records.h"
#include "scan/formats/read_cloud.h"
#include "scan_samples.h"

namespace treerec {
namespace {

using scan_test::read_text_of;

constexpr double kSurvey = 1200.0 / 3937.0;

template <typename T>
void put(std::string& bytes, size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

struct Record {
    uint16_t id;
    std::string bytes;
    std::string user = "LASF_Projection";
};

// A LAS file of these points, whose classes go round. format: 1 or 6.
std::string las(const std::vector<DVec3>& points, const std::vector<Record>& records, int format = 1,
                const std::vector<uint8_t>& classes = {0}, const std::string& extra_values = "") {
    const bool late = format >= 6;
    std::string bytes(late ? 375 : 227, '\0');
    std::memcpy(bytes.data(), "LASF", 4);
    bytes[24] = 1;
    bytes[25] = late ? 4 : 2;
    put(bytes, 94, static_cast<uint16_t>(bytes.size()));
    put(bytes, 100, static_cast<uint32_t>(records.size()));
    bool wkt = false;
    for (const Record& record : records) {
        std::string head(54, '\0');
        std::memcpy(head.data() + 2, record.user.data(), record.user.size());
        put(head, 18, record.id);
        put(head, 20, static_cast<uint16_t>(record.bytes.size()));
        bytes += head + record.bytes;
        wkt = wkt || record.id == 2112;
    }
    put(bytes, 6, static_cast<uint16_t>(wkt ? 0x10 : 0));
    const size_t extra = extra_values.empty() ? 0 : 1;
    put(bytes, 96, static_cast<uint32_t>(bytes.size()));
    bytes[104] = static_cast<char>(format);
    const size_t stride = (late ? 30 : 28) + extra;
    put(bytes, 105, static_cast<uint16_t>(stride));
    put(bytes, 107, static_cast<uint32_t>(points.size()));
    if (late) put(bytes, 247, static_cast<uint64_t>(points.size()));
    DVec3 low = points[0], high = points[0];
    for (const DVec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    for (int axis = 0; axis < 3; axis++) {
        put(bytes, 131 + 8 * static_cast<size_t>(axis), 1e-7);
        put(bytes, 155 + 8 * static_cast<size_t>(axis), std::floor(low[axis]));
        put(bytes, 179 + 16 * static_cast<size_t>(axis), high[axis]);
        put(bytes, 187 + 16 * static_cast<size_t>(axis), low[axis]);
    }
    for (size_t i = 0; i < points.size(); i++) {
        std::string record(stride, '\0');
        for (int axis = 0; axis < 3; axis++)
            put(record, 4 * static_cast<size_t>(axis),
                static_cast<int32_t>(std::lround((points[i][axis] - std::floor(low[axis])) * 1e7)));
        record[late ? 16 : 15] = static_cast<char>(classes[i % classes.size()]);
        if (extra) record.back() = extra_values[i % extra_values.size()];
        bytes += record;
    }
    return bytes;
}

std::vector<DVec3> column(double height, size_t count = 200) {
    std::vector<DVec3> points;
    for (size_t i = 0; i < count; i++)
        points.emplace_back(600000.0 + 0.001 * static_cast<double>(i % 7),
                            200000.0 + 0.01 * static_cast<double>(i % 3),
                            height * static_cast<double>(i) / static_cast<double>(count - 1));
    return points;
}

std::string keys(const std::vector<std::pair<uint16_t, uint16_t>>& pairs) {
    std::string bytes(8, '\0');
    put(bytes, 0, uint16_t{1});
    put(bytes, 2, uint16_t{1});
    put(bytes, 6, static_cast<uint16_t>(pairs.size()));
    for (const auto& [key, value] : pairs) {
        std::string entry(8, '\0');
        put(entry, 0, key);
        put(entry, 4, uint16_t{1});
        put(entry, 6, value);
        bytes += entry;
    }
    return bytes;
}

struct Read {
    PointCloud cloud;
    ReadCloudReport report;
    OrientReport orient;
    double height = 0.0;  // metres
};

Read read(const std::string& bytes, const OrientOptions& options = {}, const ReadCloudOptions& reading = {}) {
    Read result;
    result.cloud = read_cloud_bytes("a.las", bytes, reading, &result.report);
    OrientOptions upright = options;
    upright.up = UpAxis::kZ;
    result.orient = orient_cloud(result.cloud, upright);
    float low = 1e9F, high = -1e9F;
    for (const Vec3& p : result.cloud.positions) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    result.height = static_cast<double>(high - low);
    return result;
}

bool says(const std::vector<std::string>& warnings, const std::string& what) {
    return std::any_of(warnings.begin(), warnings.end(),
                       [&](const std::string& warning) { return warning.find(what) != std::string::npos; });
}

std::string projected(const std::string& unit) {
    return "PROJCS[\"x\",GEOGCS[\"NAD83\",DATUM[\"d\",SPHEROID[\"GRS 1980\",6378137,298.257222101]],PRIMEM["
           "\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],PROJECTION[\"Transverse_Mercator\"],"
           "PARAMETER["
           "\"false_easting\",492125]," +
           unit + "]";
}

const std::string kFeetUnit = "UNIT[\"US survey foot\",0.304800609601219]";
const std::string kMetreUnit = "UNIT[\"metre\",1]";

TEST(LasUnits, TheFileSaysHowLongAUnitIs) {
    const auto vertical = [](const std::string& unit) {
        return "VERT_CS[\"NAVD88\",VERT_DATUM[\"d\",2005]," + unit + ",AXIS[\"Up\",UP]]";
    };
    const std::string modern =
        "COMPOUNDCRS[\"x\",PROJCRS[\"p\",BASEGEOGCRS[\"b\",DATUM[\"d\",ELLIPSOID[\"e\",6378137,298.25,"
        "LENGTHUNIT["
        "\"metre\",1]]]],CONVERSION[\"c\",METHOD[\"Transverse Mercator\"],PARAMETER[\"False "
        "easting\",1640416.667,"
        "LENGTHUNIT[\"metre\",1]]],CS[Cartesian,2],AXIS[\"easting\",east],AXIS[\"northing\",north],"
        "LENGTHUNIT[\"US "
        "survey "
        "foot\",0.304800609601219]],VERTCRS[\"v\",VDATUM[\"d\"],CS[vertical,1],AXIS[\"up\",up],LENGTHUNIT["
        "\"US survey foot\",0.304800609601219]]]";
    const std::string in_axes =
        "PROJCRS(\"p\",CS(Cartesian,3),AXIS(\"e\",east,ORDER(1),LENGTHUNIT(\"foot\",0.3048)),AXIS(\"n\","
        "north,"
        "LENGTHUNIT(\"foot\",0.3048)),AXIS(\"h\",up,LENGTHUNIT(\"foot\",0.3048)))";
    struct Case {
        Record record;
        double unit;
    };
    for (const Case& c : std::vector<Case>{
             {{2112, "COMPD_CS[\"x\"," + projected(kFeetUnit) + "," + vertical(kFeetUnit) + "]"}, kSurvey},
             {{2112, projected(kFeetUnit)}, kSurvey},
             {{2112, modern}, kSurvey},
             {{2112, in_axes}, 0.3048},
             {{2112,
               "BOUNDCRS[SOURCECRS[" + projected(kFeetUnit) + "],TARGETCRS[" + projected(kMetreUnit) + "]]"},
              kSurvey},
             {{2112, projected(kMetreUnit)}, 1.0},
             {{34735, keys({{1024, 1}, {3072, 32767}, {3076, 9003}, {4099, 9003}})}, kSurvey},
             {{34735, keys({{1024, 1}, {3072, 2260}, {3076, 9002}})}, 0.3048},
             {{34735, keys({{1024, 1}, {3072, 26912}, {3076, 9001}})}, 1.0}}) {
        for (const int format : {1, 6}) {
            const Read got = read(las(column(23.0), {c.record}, format));
            EXPECT_NEAR(got.orient.metres_per_unit, c.unit, 1e-9) << c.record.bytes;
            EXPECT_NEAR(got.height, 23.0 * c.unit, 1e-4);
            EXPECT_FALSE(got.orient.scale_guessed) << c.record.bytes;
            EXPECT_TRUE(got.report.warnings.empty() && got.orient.warnings.empty()) << c.record.bytes;
            EXPECT_NE(got.report.format.find(c.unit == 1.0 ? "metres" : "feet"), std::string::npos);
            // What the user says goes before it.
            OrientOptions told;
            told.metres_per_unit = 0.5;
            EXPECT_NEAR(read(las(column(23.0), {c.record}, format), told).height, 11.5, 1e-4);
        }
    }
}

TEST(LasUnits, HeightsMayHaveAUnitOfTheirOwn) {
    const std::string wkt = "COMPD_CS[\"x\"," + projected(kFeetUnit) +
                            ",VERT_CS[\"v\",VERT_DATUM[\"d\",2005]," + kMetreUnit + "]]";
    for (const Record& record :
         {Record{2112, wkt}, Record{34735, keys({{1024, 1}, {3072, 2260}, {3076, 9003}, {4099, 9001}})}}) {
        const Read got = read(las(column(7.0), {record}));
        EXPECT_NEAR(got.height, 7.0, 1e-4);
        EXPECT_NEAR(got.orient.metres_per_unit, kSurvey, 1e-9);
        EXPECT_TRUE(says(got.report.warnings, "heights in metres")) << record.bytes;
    }
    // Nothing is known of the plan, but the heights are in feet: no tree is as wide as it is made of both.
    EXPECT_NEAR(read(las(column(23.0), {{34735, keys({{3072, 2260}, {4099, 9003}})}})).height, 23.0 * kSurvey,
                1e-4);
}

TEST(LasUnits, ANumberAloneIsDoubtedAndUtmIsNot) {
    Read got = read(las(column(23.0), {{34735, keys({{1024, 1}, {3072, 2260}})}}));
    EXPECT_NEAR(got.height, 23.0, 1e-4);
    ASSERT_EQ(got.orient.warnings.size(), 1u);
    EXPECT_TRUE(says(got.orient.warnings, "EPSG:2260") && says(got.orient.warnings, "--unit"));
    OrientOptions told;
    told.metres_per_unit = kSurvey;
    EXPECT_TRUE(read(las(column(23.0), {{34735, keys({{3072, 2260}})}}), told).orient.warnings.empty());
    got = read(las(column(23.0), {{34735, keys({{1024, 1}, {3072, 32633}})}}));
    EXPECT_TRUE(got.orient.warnings.empty());
}

// It was once taken at 100 m per unit, and for centimetres.
TEST(LasUnits, WithoutAWordAUnitIsAMetre) {
    for (const double height : {0.05, 0.2, 3.0, 90.0, 150.0, 210.0}) {
        const Read got = read(las(column(height), {}));
        EXPECT_EQ(got.orient.metres_per_unit, 1.0) << height;
        EXPECT_NEAR(got.height, height, 1e-4);
        EXPECT_EQ(got.orient.warnings.empty(), height > 0.3 && height < 120.0) << height;
    }
}

TEST(LasUnits, DegreesAreRefusedWhereTheyAreMeant) {
    std::vector<DVec3> places;
    for (int i = 0; i < 200; i++)
        places.emplace_back(8.5 + 1e-6 * (i % 5), 47.3 + 1e-6 * (i % 7), 0.05 * i);
    const std::string geographic =
        "GEOGCS[\"WGS 84\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.25]],UNIT[\"degree\",0.01745]]";
    for (const Record& record : {Record{2112, geographic}, Record{34735, keys({{1024, 2}, {2048, 4326}})}}) {
        try {
            read(las(places, {record}));
            ADD_FAILURE() << "degrees were read as lengths";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("degrees"), std::string::npos) << error.what();
        }
        EXPECT_NEAR(read(las(column(9.0), {record})).height, 9.0, 1e-4) << "a map that is called degrees";
    }
}

// Whatever stands there instead of well-known text says nothing, and breaks nothing.
TEST(LasUnits, DamagedRecordsSayNothing) {
    const std::string whole = "COMPD_CS[\"x\"," + projected(kFeetUnit) + "]";
    for (size_t length = 0; length < whole.size(); length += 3)
        EXPECT_EQ(read(las(column(9.0), {{2112, whole.substr(0, length)}})).orient.metres_per_unit, 1.0)
            << length;
    std::string deep;
    for (int i = 0; i < 5000; i++)
        deep += "PROJCS[";
    EXPECT_EQ(read(las(column(9.0), {{2112, deep}})).orient.metres_per_unit, 1.0);
    for (const std::string& odd : {std::string("UNIT[\"m\",nan]"), std::string("UNIT[\"m\",-3]"),
                                   std::string("UNIT[\"m\",1e300]"), std::string("UNIT[]")})
        EXPECT_EQ(read(las(column(9.0), {{2112, projected(odd)}})).orient.metres_per_unit, 1.0) << odd;
    const std::string good = keys({{1024, 1}, {3076, 9003}});
    for (size_t length = 0; length < good.size(); length++)
        read(las(column(9.0), {{34735, good.substr(0, length)}}));
    std::string cut = las(column(9.0), {{34735, good}});
    put(cut, 227 + 20, uint16_t{60000});
    EXPECT_EQ(read(cut).orient.metres_per_unit, 1.0);
}

TEST(LasClasses, NoiseIsLeftOutAndCounted) {
    const std::vector<DVec3> points = column(9.0, 1000);
    for (const int format : {1, 6}) {
        const std::vector<uint8_t> classes{5, 7, 2, 18, 5};
        const std::string bytes = las(points, {}, format, classes);
        const Read plain = read(bytes);
        EXPECT_EQ(plain.cloud.size(), 600u);
        EXPECT_TRUE(says(plain.report.warnings, "400 of 1000 points are of the classes 7 or 18")) << format;
        const auto size = [&](const char* wanted) {
            return read(bytes, {}, {{}, parse_classes(wanted)}).cloud.size();
        };
        EXPECT_EQ(size("all"), 1000u);
        EXPECT_EQ(size("5"), 400u);
        EXPECT_EQ(size("2,7"), 400u);
        EXPECT_EQ(size("2-6"), 600u);
        EXPECT_THROW(size("9"), Error);
        EXPECT_THROW(read(las(points, {}, format, {7})), Error);
    }
    for (const char* wrong : {"x", "1-", "3-2", "256", "-1", "1,,2", "1;2"})
        EXPECT_THROW(parse_classes(wrong), Error) << wrong;
    EXPECT_FALSE(parse_classes("").has_value());
}

TEST(LasClasses, LabelsStandInTheClassesOrInExtraBytes) {
    const std::vector<DVec3> points = column(9.0, 1000);
    EXPECT_TRUE(read(las(points, {})).cloud.labels.empty()) << "one class tells nothing";
    const Read classes = read(las(points, {}, 6, {1, 0}));
    EXPECT_EQ(classes.cloud.labels.column, "classification");
    EXPECT_EQ(classes.cloud.labels.values[0], 1);
    std::string description(192, '\0');
    description[2] = 1;  // unsigned char
    std::memcpy(description.data() + 4, "foliage", 7);
    const Read extra =
        read(las(points, {{4, description, "LASF_Spec"}}, 6, {1, 2}, std::string("\0\1\1", 3)));
    EXPECT_EQ(extra.cloud.labels.column, "foliage");
    EXPECT_TRUE(extra.cloud.labels.leaf_is_one);
    EXPECT_EQ(extra.cloud.labels.values, [&] {
        std::vector<uint8_t> wanted;
        for (size_t i = 0; i < points.size(); i++)
            wanted.push_back(i % 3 == 0 ? 0 : 1);
        return wanted;
    }());
    // A field that the points have no room for.
    EXPECT_EQ(read(las(points, {{4, description, "LASF_Spec"}}, 6, {1, 2})).cloud.labels.column,
              "classification");
}

// What rounding to 32-bit numbers, or to a few digits, far from zero leaves of a tree.
TEST(CoordinateSteps, ACloudThatWasRoundedAwayIsRefused) {
    const auto text = [](double x, double y, const auto& round) {
        std::string all;
        for (const Vec3& p : scan_test::tree_points(1)) {
            char line[120];
            std::snprintf(line, sizeof line, "%.10g %.10g %.6f\n", round(x + static_cast<double>(p.x)),
                          round(y + static_cast<double>(p.z)), static_cast<double>(p.y));
            all += line;
        }
        return all;
    };
    const auto as_float = [](double v) { return static_cast<double>(static_cast<float>(v)); };
    const auto sentence = [](const std::string& bytes) { return scan_test::error_of(bytes, "a.xyz"); };
    EXPECT_NE(
        sentence(text(443210.0, 5431234.0, as_float)).find("coordinates come in steps of 0.5 m along y"),
        std::string::npos);
    EXPECT_NE(sentence(text(443210.0, 5431234.0, as_float)).find("Shift"), std::string::npos);
    EXPECT_NE(sentence(text(-7e6, 30.0, as_float)).find("steps of 0.5 m along x"), std::string::npos);
    const auto to_metres = [](double v) { return std::round(v); };
    EXPECT_NE(sentence(text(443210.0, 5431234.0, to_metres)).find("steps of 1 m"), std::string::npos);
    EXPECT_EQ(sentence(text(443210.0, 5431234.0, [](double v) { return v; })), "");
    EXPECT_EQ(sentence(text(443.0, 1234.0, as_float)), "");
    EXPECT_EQ(sentence(text(0.0, 0.0, [](double v) { return std::round(20.0 * v) / 20.0; })), "")
        << "voxels near zero are coarse, and no mistake";
}

}  // namespace
}  // namespace treerec
