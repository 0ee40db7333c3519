#include "campaign_sample.hpp"
#include "results/archive.hpp"

int main(int, char** argv) {
  mpm::write_archive(argv[1], campaign_sample());
}
