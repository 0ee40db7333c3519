#include <string>

#include <catch2/catch.hpp>

#include "analysis/methods/method_file.hpp"

namespace {

using namespace mpm;

TEST_CASE("method file: a name is part of options, files, tables and pages, and means nothing else there") {
  for (const char* const name : {"mine", "x", "KL-2_b", "_a", "2nd", "alle"})
    CHECK(is_method_name(name));
  CHECK(is_method_name(std::string(64, 'a')));
  for (const char* const name : {"", "-x", "all", "experiments", "findings", "loops", "a,b", "a b", "a.b",
                                 "a/b", "=a", "<a>", "gr\xC3\xB6\xC3\x9F\x65", "a\n"})
    CHECK_FALSE(is_method_name(name));
  CHECK_FALSE(is_method_name(std::string(65, 'a')));
}

TEST_CASE("method file: answers are of a method, a variant of it, or a composite of two") {
  for (const char* const name : {"mine", "sun:corrected", "sse+lasso", "mine+sun:corrected"})
    CHECK(is_answering_name(name));
  for (const char* const name : {"", ":corrected", "sun:", "sse+", "+lasso", "a:b c", "a+all"})
    CHECK_FALSE(is_answering_name(name));
  std::string many = "a";
  for (int i = 0; i < 100000; ++i)
    many += "+a";
  CHECK_FALSE(is_answering_name(many));
}

}  // namespace
