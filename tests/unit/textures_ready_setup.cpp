// Tests have the pictures that the build drew, as the programs do: drawing those of a kind takes seconds.
#include <gtest/gtest.h>

#include "exchange/ready_pictures.h"

namespace treerec {
namespace {

class ReadyPictures : public ::testing::Environment {
    void SetUp() override { use_ready_pictures(); }
};

const ::testing::Environment* const kReady = ::testing::AddGlobalTestEnvironment(new ReadyPictures);

}  // namespace
}  // namespace treerec
