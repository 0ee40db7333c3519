#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "base/system/program_trust.hpp"

/// The programs of tests are our own.
int main(int argc, char** argv) {
  mpm::trust_every_program();
  return Catch::Session().run(argc, argv);
}
