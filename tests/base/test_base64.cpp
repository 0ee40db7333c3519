#include <span>
#include <string_view>

#include <catch2/catch.hpp>

#include "base/base64.hpp"

namespace mpm {

TEST_CASE("base64: the examples of RFC 4648, section 10, and every value of six bits") {
  const auto text_of = [](std::string_view bytes) { return base64(std::as_bytes(std::span(bytes))); };
  CHECK(text_of("").empty());
  CHECK(text_of("f") == "Zg==");
  CHECK(text_of("fo") == "Zm8=");
  CHECK(text_of("foo") == "Zm9v");
  CHECK(text_of("foob") == "Zm9vYg==");
  CHECK(text_of("fooba") == "Zm9vYmE=");
  CHECK(text_of("foobar") == "Zm9vYmFy");
  CHECK(text_of("\xfb\xff\xbf") == "+/+/");
}

}  // namespace mpm
