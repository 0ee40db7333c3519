// usage: write_sample_archive FILE [empty|scenarios|faultless|further]

#include <cstdio>
#include <exception>
#include <string>

#include "results/archive/archive.hpp"
#include "tests/results/campaign_sample.hpp"
#include "tests/results/made_up_campaign.hpp"

int main(int argc, char** argv) {
  if (argc < 2)
    return 1;
  try {
    const std::string which = argc == 2 ? "" : argv[2];
    const mpm::Campaign campaign = which == "empty"       ? mpm::testing::empty_campaign()
                                   : which == "scenarios" ? mpm::testing::scenario_campaign()
                                   : which == "faultless" ? mpm::testing::faultless_campaign()
                                   : which == "further"   ? mpm::testing::rich_campaign()
                                                          : campaign_sample();
    mpm::write_archive(argv[1], campaign, mpm::findings_of(campaign));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
