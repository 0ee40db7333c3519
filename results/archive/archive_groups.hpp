#pragma once

#include <optional>
#include <string>
#include <vector>

#include "results/archive/campaign.hpp"
#include "results/archive/hdf5_file.hpp"
#include "results/archive/record_tables.hpp"

namespace mpm {

// The parts of an archive. The functions that write and read a part are next to each other. A group has its
// own dimensions, so that it can be opened alone (`xarray.open_dataset(path, group="basis")`) with the names
// of its variables. `file` is for the messages of ArchiveError, which all readers throw.

/// Writes the root attributes.
void write_heading(Hdf5Group& root, const Campaign& campaign);
/// Checks that the file is an archive of this version, and reads study and info.
Campaign read_heading(const Hdf5Group& root, const std::string& file);

/// Writes the tables of record_tables(): the root group, /methods/NAME, /trajectories (left out if no loop
/// was kept) and /s0_perturbation. ArchiveRecordReader reads them.
void write_records(Hdf5Group& root, const Campaign& campaign, const std::vector<RecordTable>& tables);

/// Writes the attributes of /methods/NAME, which describe the methods. Their groups must exist already.
void write_methods(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings);
/// Reads the methods of an archive, including those that this program does not have.
std::vector<CampaignMethod> read_methods(const Hdf5Group& root, const Study& study, const std::string& file);
/// Reads the processor times of the methods, which are not part of any record.
std::vector<double> read_method_times(const Hdf5Group& root, const AssessmentForms& forms);

/// /nominal: T0.
void write_nominal(Hdf5Group& root, const Study& study, const NominalSensitivity& sensitivity);
NominalSensitivity read_nominal(const Hdf5Group& root, const Study& study, const std::string& file);

/// /nominal_fixed: T0 with the fixed MVs of the study held. The group is left out if the study fixes none.
void write_nominal_fixed(Hdf5Group& root, const Study& study,
                         const std::optional<NominalSensitivity>& sensitivity);
std::optional<NominalSensitivity> read_nominal_fixed(const Hdf5Group& root, const Study& study,
                                                     const std::string& file);

/// /nominal_direct: the direct step responses beside an identified T0, and how far they are from it. The
/// group is left out unless the study wants T0 identified.
void write_nominal_direct(Hdf5Group& root, const Study& study, const BasisCase& basis);
std::optional<NominalSensitivity> read_nominal_direct(const Hdf5Group& root, const Study& study,
                                                      const NominalSensitivity& identified,
                                                      const std::string& file);

/// /s0_perturbation: what follows from the records in that group and is not read back (fits, ratios). The
/// group is left out if the study asks for no perturbation.
void write_s0_perturbation(Hdf5Group& root, const Campaign& campaign);

/// /scenarios: names and truth of the named scenarios. They follow from the study and are not read back. A
/// study of random experiments has no such group.
void write_scenarios(Hdf5Group& root, const Campaign& campaign);

/// /basis: the operating point and the run without mismatch and disturbance.
void write_basis(Hdf5Group& root, const Study& study, const BasisCase& basis);
/// `sensitivity` is the result of read_nominal(): the basis case has the same active limits.
BasisCase read_basis(const Hdf5Group& root, const Study& study, NominalSensitivity sensitivity,
                     const std::string& file);

/// /calibration: the scores of the calibration loops. The group is left out if the study asks for none.
void write_calibration(Hdf5Group& root, const Campaign& campaign);
/// `campaign` must already have its study and its methods.
Calibration read_calibration(const Hdf5Group& root, const Campaign& campaign, const std::string& file);

/// /audit: the results of the audit. The group is left out if no step was audited.
void write_audit(Hdf5Group& root, const std::vector<AuditedStep>& audit);
std::vector<AuditedStep> read_audit(const Hdf5Group& root, const std::string& file);

/// /findings: the rows of the table of findings, and the arrays they are computed from. They follow from the
/// rest of the archive and are not read back.
void write_findings(Hdf5Group& root, const Campaign& campaign, const StudyFindings& findings);

}  // namespace mpm
