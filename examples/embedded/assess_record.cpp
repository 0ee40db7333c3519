// What `mpmbench assess STUDY RECORD` says of a record of a plant, with 20 simulated records beside it.

#include <cstdio>

#include "analysis/records/record_assessment.hpp"
#include "analysis/study_files/study_file.hpp"
#include "results/assess/assessment_sentences.hpp"
#include "results/records/plant_record_file.hpp"
#include "solvers/qp_solver_factory.hpp"

int main(int count, char** words) {
  if (count != 3) {
    std::fputs("usage: assess_record STUDY RECORD\n", stderr);
    return 2;
  }
  const mpm::Study study = mpm::load_study(words[1]);
  const mpm::QpSolverFactory solver = mpm::qp_solver_factory("auto");
  const mpm::RecordAssessment assessment = mpm::assess_record(
      study, mpm::load_plant_record(study, words[2]), {.trials = 20}, solver, mpm::trials_in_memory(solver));
  for (const std::string& sentence : mpm::verdict_sentences(assessment))
    std::printf("%s\n", sentence.c_str());
}
