// A tree as Python has it.
#pragma once

#include <nanobind/nanobind.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pipeline/reconstruct.h"

namespace treerec {

// Never changed once it is made.
class PythonTree {
  public:
    // made: of a tree that was read or drawn the tree and its foliage alone. leaves: the preset that suits
    // it. report: JSON of a reconstruction, else empty.
    PythonTree(std::shared_ptr<const Reconstruction> made, std::string leaves, uint64_t seed,
               std::string report = {});

    const Reconstruction& made() const { return *made_; }
    const Tree& tree() const { return made_->tree; }
    const std::string& leaves() const { return leaves_; }
    uint64_t seed() const { return seed_; }
    const std::string& report() const { return report_; }
    // By node, parents before children.
    const std::vector<DVec3>& positions() const { return positions_; }
    const std::vector<double>& radii() const { return radii_; }
    const std::vector<int32_t>& parents() const { return parents_; }
    const std::vector<uint8_t>& flags() const { return flags_; }

  private:
    std::shared_ptr<const Reconstruction> made_;
    std::string leaves_;
    uint64_t seed_;
    std::string report_;
    std::vector<DVec3> positions_;
    std::vector<double> radii_;
    std::vector<int32_t> parents_;
    std::vector<uint8_t> flags_;
};

void bind_tree(nanobind::module_& module);

}  // namespace treerec
