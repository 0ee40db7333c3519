#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "results/archive/archive.hpp"
#include "results/records/netcdf_columns.hpp"
#include "tests/results/made_up_campaign.hpp"
#include "tests/scenarios/mutator.hpp"

namespace mpm {
namespace {

using namespace testing;

RecordColumns columns_of(const std::string& content) {
  const auto bytes = std::as_bytes(std::span(content));
  return netcdf_columns({bytes.begin(), bytes.end()}, "r.nc", "experiment");
}

TEST_CASE("a damaged netCDF-4 file is read or refused by name, also where HDF5 crashes on it", "[records]") {
  const TemporaryFolder folder;
  const Campaign campaign = drawn_campaign();
  write_archive(folder / "a.h5", campaign, findings_of(campaign));
  const std::string whole = file_content(folder / "a.h5");
  const RecordColumns right = columns_of(whole);
  CHECK(right.rows() == campaign.records.size());
  CHECK(right.lines.back() == right.rows());
  int read = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    INFO("seed " << seed);
    const std::string damaged = Mutator(seed).mutated_bytes(whole);
    try {
      columns_of(damaged);
      ++read;
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Catch::StartsWith("r.nc: found ") && Catch::Contains("; allowed: "));
    }
  }
  CHECK(read > 0);
  CHECK(read < 60);
}

}  // namespace
}  // namespace mpm
