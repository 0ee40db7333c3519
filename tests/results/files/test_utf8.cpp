#include <catch2/catch.hpp>

#include "results/files/utf8.hpp"

TEST_CASE("lower case changes capital letters and nothing else") {
  CHECK(mpm::in_lower_case("") == "");
  CHECK(mpm::in_lower_case("FIC-101.PV [kg/h]") == "fic-101.pv [kg/h]");
  CHECK(mpm::in_lower_case("M\xC3\x84RZ") == "m\xC3\x84rz");  // bytes of UTF-8 stay
}
