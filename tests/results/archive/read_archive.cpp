// Reads the archives whose names come on standard input, one a line, and summarises each. A line of the
// answer says "read", or why not.

#include <iostream>
#include <string>

#include "results/archive/archive.hpp"
#include "results/document/document_json.hpp"
#include "results/document/document_text.hpp"
#include "results/files/archive_error.hpp"
#include "results/summary/comparison.hpp"
#include "results/summary/summary.hpp"

namespace {

std::string answer(const std::string& path) {
  try {
    const mpm::Campaign campaign = mpm::read_archive(path);
    const mpm::StudyFindings findings = mpm::findings_of(campaign);
    const bool said = !mpm::document_text(summary_document(campaign, findings, path)).empty() &&
                      !mpm::document_json(summary_document(campaign, findings, "out.h5")).empty() &&
                      !mpm::document_json(comparison_document(campaign, findings)).empty();
    return said ? "read" : "no summary";
  } catch (const mpm::ArchiveError& error) {
    return error.what();
  }
}

}  // namespace

int main() {
  for (std::string path; std::getline(std::cin, path);)
    std::cout << answer(path) << std::endl;
}
