#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include <catch2/catch.hpp>

#include "base/non_finite.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "tests/results/made_up_campaign.hpp"

namespace {

using namespace mpm;
using namespace mpm::testing;

/// Opens what `fill` wrote; the folder keeps the file.
Hdf5Group written(const TemporaryFolder& folder, const std::function<void(Hdf5Group&)>& fill) {
  const Hdf5File file = Hdf5File::create("f");
  Hdf5Group root = file.root();
  fill(root);
  write_file_atomically(folder / "f.h5", file.image());
  return Hdf5File::open(folder / "f.h5").root();
}

template <class T>
void check_type(const std::vector<T>& values) {
  const TemporaryFolder folder;
  const Hdf5Group root = written(folder, [&](Hdf5Group& group) {
    group.write_dimension("x", values, {});
    group.write("v", {"x"}, values, {{"units", "1"}});
    group.write("one", {}, std::vector<T>{values.back()}, {});
  });
  CHECK(root.read_list<T>("x") == values);
  CHECK(root.read<T>("v", {values.size()}) == values);
  CHECK(root.read<T>("one", {}) == std::vector<T>{values.back()});
}

TEST_CASE("hdf5 file: values of each type come back") {
  check_type<std::int8_t>({-128, 0, 127});
  check_type<std::int32_t>({std::numeric_limits<int>::min(), 0, std::numeric_limits<int>::max()});
  check_type<std::int64_t>(
      {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()});
  check_type<double>({0.1, mpm::kInfinity, -1e-320});
  check_type<std::string>({"", "a", "\xC3\xBC", std::string(100000, 'x')});
}

TEST_CASE("hdf5 file: several dimensions stand row by row, also when they are compressed") {
  const TemporaryFolder folder;
  std::vector<double> values(3 * 700 * 101);  // more than a chunk, and not a multiple of one
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = std::sqrt(static_cast<double>(i));
  const Hdf5Group root = written(folder, [&](Hdf5Group& group) {
    group.write_dimension("a", std::vector<std::int32_t>(3), {});
    group.write_dimension("b", std::vector<std::int32_t>(700), {});
    group.write_dimension("c", std::vector<std::int32_t>(101), {});
    group.write("v", {"a", "b", "c"}, values, {});
  });
  CHECK(root.read<double>("v", {3, 700, 101}) == values);
}

TEST_CASE("hdf5 file: attributes of each type come back, also very long texts") {
  const TemporaryFolder folder;
  const std::string text(1'000'000, 'x');  // HDF5 allows 64 KiB in an attribute itself
  const Hdf5Group root = written(folder, [&](Hdf5Group& group) {
    group.write_attribute("text", text);
    group.write_attribute("number", 0.1);
    group.write_attribute("seed", std::numeric_limits<std::uint64_t>::max());
    group.write_attribute("i32", std::int32_t{-1});
    group.write_attribute("i64", std::int64_t{-1});
    group.write_attribute("list", std::vector<std::int32_t>{1, 0});
  });
  CHECK(root.attribute<std::string>("text") == text);
  CHECK(root.attribute<double>("number") == 0.1);
  CHECK(root.attribute<std::uint64_t>("seed") == std::numeric_limits<std::uint64_t>::max());
  CHECK(root.attribute<std::int32_t>("i32") == -1);
  CHECK(root.attribute<std::int64_t>("i64") == -1);
  CHECK(root.attribute<std::vector<std::int32_t>>("list") == std::vector<std::int32_t>{1, 0});
}

TEST_CASE("hdf5 file: what is missing, or of another type or shape, is named with its file and path") {
  const TemporaryFolder folder;
  const Hdf5Group root = written(folder, [](Hdf5Group& group) {
    group.write_attribute("number", 0.1);
    group.write_attribute("list", std::vector<std::int32_t>{1, 0});
    Hdf5Group inner = group.create_group("inner");
    inner.write_dimension("x", std::vector<std::int32_t>{1, 2}, {});
    inner.write("one", {}, std::vector<double>{1.0}, {});
  });
  using Catch::Contains;
  const std::string file = (folder / "f.h5").string();
  const Hdf5Group inner = root.group("inner");
  CHECK(root.has_group("inner"));
  CHECK_FALSE(root.has_group("outer"));
  CHECK_THROWS_WITH(root.group("outer"), file + ": group '/outer': missing");
  CHECK_THROWS_WITH(inner.read<double>("v", {}), file + ": variable '/inner/v': missing");
  CHECK_THROWS_WITH(inner.read<double>("x", {2}), Contains("'/inner/x': another type"));
  CHECK_THROWS_WITH(inner.read<std::int8_t>("x", {2}), Contains("'/inner/x': another type"));
  CHECK_THROWS_WITH(inner.read<std::string>("x", {2}), Contains("'/inner/x': another type"));
  CHECK_THROWS_WITH(inner.read<std::int32_t>("x", {2, 1}), Contains("shape (2) where (2, 1) is expected"));
  CHECK_THROWS_WITH(inner.read_list<double>("one"), Contains("0 dimensions where one is expected"));
  CHECK_THROWS_WITH(root.attribute<std::string>("text"), file + ": attribute '/text': missing");
  CHECK_THROWS_WITH(root.attribute<std::string>("number"), Contains("'/number': another type"));
  CHECK_THROWS_WITH(root.attribute<std::int32_t>("list"), Contains("2 values where one is expected"));
}

TEST_CASE("hdf5 file: what cannot be made is refused") {
  const Hdf5File file = Hdf5File::create("f");
  Hdf5Group root = file.root();
  root.write_dimension("x", std::vector<std::int32_t>{1}, {});
  CHECK_THROWS_AS(root.write_dimension("x", std::vector<std::int32_t>{1}, {}), ArchiveError);
  CHECK_THROWS_WITH(root.write("v", {"y"}, std::vector<double>{1}, {}), "f: dimension '/y': missing");
  root.create_group("g");
  CHECK_THROWS_AS(root.create_group("g"), ArchiveError);
}

TEST_CASE("hdf5 file: the same content is the same bytes, also a second later") {
  const auto image = [] {
    const Hdf5File file = Hdf5File::create("f");
    Hdf5Group root = file.root();
    root.write_dimension("x", std::vector<std::string>{"a", "b"}, {{"long_name", "x"}});
    root.create_group("g").write_attribute("a", 1.0);
    return file.image();
  };
  const std::vector<std::byte> first = image();
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 would stamp objects to the second
  CHECK(image() == first);
}

}  // namespace
