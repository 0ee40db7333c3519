# Programs that tests run. They are looked for in the system's folders only: another python3 that comes first
# in PATH lacks h5py and xarray, and another clang-format formats differently.
#
# A program that is not there does not stop a build (run.sh needs none of them); its tests fail and say so.

foreach(tool python3 clang-format clang-tidy chromium octave-cli mpirun)
  string(TOUPPER "MPMBENCH_${tool}" variable)
  string(REPLACE "-" "_" variable "${variable}")
  find_program(${variable} ${tool} PATHS /usr/bin /usr/local/bin NO_DEFAULT_PATH
    DOC "The system's ${tool}, for tests")
endforeach()
