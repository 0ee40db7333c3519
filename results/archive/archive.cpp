#include "results/archive/archive.hpp"

#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "results/archive/archive_groups.hpp"
#include "results/archive/archive_record_reader.hpp"
#include "results/files/archive_error.hpp"
#include "results/files/atomic_file.hpp"
#include "results/files/file_seal.hpp"

namespace mpm {
namespace {

enum class RecordPlace { memory, file };

Campaign read_groups(const std::filesystem::path& path, RecordPlace place) {
  const std::string file = path.string();
  const Hdf5Group root = Hdf5File::open(path).root();
  Campaign campaign = read_heading(root, file);
  const Study& study = campaign.study;
  campaign.methods = read_methods(root, study, file);
  campaign.study.methods = method_names(campaign);
  const AssessmentForms forms = forms_of(campaign);
  const auto reader =
      std::make_shared<const ArchiveRecordReader>(root, study, forms, record_tables(study, forms), file);
  if (place == RecordPlace::file && !study.names_scenarios())
    campaign.streamed = streamed(reader);
  else
    campaign.records = reader->read(0, reader->size());
  campaign.calibration = read_calibration(root, campaign, file);
  campaign.audit = read_audit(root, file);
  campaign.basis = read_basis(root, study, read_nominal(root, study, file), file);
  campaign.basis.sensitivity_direct = read_nominal_direct(root, study, campaign.basis.sensitivity, file);
  campaign.basis.sensitivity_fixed = read_nominal_fixed(root, study, file);
  return campaign;
}

/// `name` is for messages.
void write_groups(const std::filesystem::path& path, const std::string& name, const Campaign& campaign,
                  const StudyFindings& findings) {
  const Hdf5File file = Hdf5File::create_at(path, name);
  Hdf5Group root = file.root();
  write_heading(root, campaign);
  write_records(root, campaign, record_tables(campaign.study, forms_of(campaign)));
  write_methods(root, campaign, findings);
  write_scenarios(root, campaign);
  write_basis(root, campaign.study, campaign.basis);
  write_nominal(root, campaign.study, campaign.basis.sensitivity);
  write_nominal_direct(root, campaign.study, campaign.basis);
  write_nominal_fixed(root, campaign.study, campaign.basis.sensitivity_fixed);
  write_s0_perturbation(root, campaign);
  write_calibration(root, campaign);
  write_audit(root, campaign.audit);
  write_findings(root, campaign, findings);
  file.finish();
}

[[noreturn]] void refuse_size(const std::filesystem::path& path) {
  throw ArchiveError(
      fmt::format("{}: not enough memory for the file or one of its variables", path.string()));
}

Campaign read_archive(const std::filesystem::path& path, RecordPlace place) {
  try {
    return read_groups(path, place);
  } catch (const std::bad_alloc&) {
    refuse_size(path);
  } catch (const std::length_error&) {
    refuse_size(path);
  }
}

}  // namespace

void write_archive(const std::filesystem::path& path, const Campaign& campaign,
                   const StudyFindings& findings) {
  write_file_atomically(path, [&](const std::filesystem::path& temporary) {
    write_groups(temporary, path.string(), campaign, findings);
    seal_file(temporary);
  });
}

Campaign read_archive(const std::filesystem::path& path) {
  return read_archive(path, RecordPlace::memory);
}

Campaign stream_archive(const std::filesystem::path& path) {
  return read_archive(path, RecordPlace::file);
}

}  // namespace mpm
