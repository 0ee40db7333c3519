// usage: read_archive FILE: reads an archive and summarises it, or says why not (exit code 2).

#include <cstdio>

#include "results/archive/archive.hpp"
#include "results/files/archive_error.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"

int main(int argc, char** argv) {
  if (argc != 2)
    return 1;
  try {
    const mpm::Campaign campaign = mpm::read_archive(argv[1]);
    const mpm::StudyFindings findings = mpm::findings_of(campaign);
    std::printf("%s", mpm::summary_text(campaign, findings, argv[1]).c_str());
    std::printf("%s", mpm::summary_json(campaign, findings).c_str());
    std::printf("%s", mpm::comparison_json(campaign, findings).c_str());
    return 0;
  } catch (const mpm::ArchiveError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
