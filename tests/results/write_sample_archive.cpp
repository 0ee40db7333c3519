// usage: write_sample_archive FILE [empty]

#include <cstdio>
#include <exception>

#include "results/archive.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

int main(int argc, char** argv) {
  if (argc < 2)
    return 1;
  try {
    mpm::write_archive(argv[1], argc == 2 ? campaign_sample() : mpm::testing::empty_campaign());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
