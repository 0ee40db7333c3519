#include <catch2/catch.hpp>

#include "scenarios/study_file_keys.hpp"
#include "tests/scenarios/documented_keys.hpp"
#include "tests/scenarios/study_texts.hpp"

namespace mpm {
namespace {

TEST_CASE("the document of the study file has exactly the keys that the reader knows", "[study_file]") {
  testing::check_documented_keys(testing::project_file("docs/study_file.md"), study_file_tables());
}

}  // namespace
}  // namespace mpm
