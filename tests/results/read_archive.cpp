// usage: read_archive FILE: reads an archive, or says why not (exit code 2).

#include <cstdio>

#include "results/archive.hpp"
#include "results/archive_error.hpp"

int main(int argc, char** argv) {
  if (argc != 2)
    return 1;
  try {
    std::printf("%zu experiments\n", mpm::read_archive(argv[1]).records.size());
    return 0;
  } catch (const mpm::ArchiveError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
