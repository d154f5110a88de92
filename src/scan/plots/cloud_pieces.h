// A cloud read piece by piece, for plots that no memory holds.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scan/formats/read_cloud.h"

namespace treerec {

// LAS files come in pieces of so many points; all other formats, which must be read as a whole, as one piece,
// which is kept for the next time.
class CloudPieces {
  public:
    // Throws as read_cloud().
    CloudPieces(std::string path, ReadCloudOptions options, size_t piece, Progress* progress);

    // Each piece in its own frame, in the order of the file. progress: gets 0..1 of this pass.
    void each(const std::function<void(const PointCloud&)>& take, Progress* progress);

    // What the reader had to say, each sentence once.
    const std::vector<std::string>& warnings() const { return warnings_; }

  private:
    // Where the points of a LAS file lie.
    struct Records {
        uint64_t data = 0, count = 0;
        size_t stride = 0;
        std::string begin;  // header and records before the points
        std::string end;    // the extended records behind them
    };

    void find_records(size_t piece);
    // A LAS file of some of the points.
    std::string file_of(std::ifstream& stream, uint64_t first, uint64_t count) const;
    void take_warnings(const ReadCloudReport& report);

    std::string path_;
    ReadCloudOptions options_;
    size_t piece_;
    std::optional<Records> records_;
    PointCloud whole_;
    std::vector<std::string> warnings_;
};

}  // namespace treerec
