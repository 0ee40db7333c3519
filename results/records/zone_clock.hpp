#pragma once

#include <memory>
#include <optional>
#include <string>

namespace mpm {

/// Returns the offset in s of a zone that is written as letters, such as CET or EDT. Returns none for unknown
/// letters, and for letters that several zones use (CST, IST, BST).
std::optional<double> offset_of_letters(const std::string& letters);

/// The clocks of a time zone, with all their changes, from the time zone database of the system.
class ZoneClock {
 public:
  /// Finds the zone by its IANA name, such as "Europe/Berlin". Errors: InputError at `place` for an unknown
  /// name.
  ZoneClock(const std::string& name, const std::string& place);
  ~ZoneClock();
  ZoneClock(ZoneClock&&) noexcept;
  ZoneClock& operator=(ZoneClock&&) noexcept;

  /// Returns the time in UTC at which the clocks show `local`; both are in s since 1970. If the clocks show
  /// it twice, `letters` decide; without letters, it is the first time unless that is before `earliest`, then
  /// the second. Returns none if no clock shows `local`, or none with these letters.
  std::optional<double> utc(double local, const std::string& letters, double earliest) const;

 private:
  struct Zone;
  std::unique_ptr<const Zone> zone_;
};

}  // namespace mpm
