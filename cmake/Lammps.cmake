# Which LAMMPS to build for: its source tree, its version, and how it was compiled.
#
# The plugin must be compiled exactly as its host was: LAMMPS has no ABI of its own, and a class whose size
# differs by one integer crashes far from the cause. Hence the source of the same version (an installed LAMMPS
# has too few headers), the same integer sizes and the same MPI.

set(LAMMPS_SOURCE_DIR "$ENV{LAMMPS_SOURCE_DIR}" CACHE PATH
    "Top folder of an untouched LAMMPS tree (holds src/version.h)")
set(LAMMPS_PREFIX "$ENV{LAMMPS_PREFIX}" CACHE PATH
    "Stock LAMMPS installed from that tree (bin/lmp), linked beside lmp-dust")
set(LAMMPS_SIZES smallbig CACHE STRING "Integer sizes of the host LAMMPS: smallbig (its default) or bigbig")
set_property(CACHE LAMMPS_SIZES PROPERTY STRINGS smallbig bigbig)
string(TOUPPER "${LAMMPS_SIZES}" DUST_SIZES)

set(how_to_get_lammps "Run cmake/get-lammps 4Jul2026, which fetches one and prints where it is, or ./bootstrap build, "
                      "or set -D LAMMPS_SOURCE_DIR=... to the top folder of a LAMMPS 4Feb2025 or 4Jul2026 tree.")
if(NOT LAMMPS_SOURCE_DIR)
  message(FATAL_ERROR "LAMMPS_SOURCE_DIR is not set. " ${how_to_get_lammps})
elseif(NOT EXISTS "${LAMMPS_SOURCE_DIR}/src/version.h")
  message(FATAL_ERROR "LAMMPS_SOURCE_DIR=${LAMMPS_SOURCE_DIR} holds no src/version.h. " ${how_to_get_lammps})
elseif(NOT DUST_SIZES MATCHES "^(SMALLBIG|BIGBIG)$")
  message(FATAL_ERROR "LAMMPS_SIZES=${LAMMPS_SIZES}: must be smallbig or bigbig, as in the LAMMPS that loads the "
                      "plugin")
endif()

# "4 Jul 2026" -> 20260704, the form in which the C library tells its version
file(STRINGS "${LAMMPS_SOURCE_DIR}/src/version.h" LAMMPS_VERSION REGEX "LAMMPS_VERSION")
string(REGEX REPLACE ".*\"([0-9]+) ([A-Z][a-z][a-z]) ([0-9]+)\".*" "\\1;\\2;\\3" date "${LAMMPS_VERSION}")
list(LENGTH date date_parts)
if(NOT date_parts EQUAL 3)
  message(FATAL_ERROR "Cannot read a version from ${LAMMPS_SOURCE_DIR}/src/version.h. " ${how_to_get_lammps})
endif()
list(GET date 0 day)
list(GET date 1 month)
list(GET date 2 year)
set(LAMMPS_VERSION "${day}${month}${year}")
set(months Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec)
list(FIND months "${month}" month)
math(EXPR LAMMPS_VERSION_NUMBER "${year} * 10000 + (${month} + 1) * 100 + ${day}")
if(LAMMPS_VERSION_NUMBER LESS 20250204)
  message(FATAL_ERROR "LAMMPS ${LAMMPS_VERSION} in ${LAMMPS_SOURCE_DIR} is too old. " ${how_to_get_lammps})
endif()
message(STATUS "LAMMPS ${LAMMPS_VERSION} (${LAMMPS_SIZES}) from ${LAMMPS_SOURCE_DIR}")

# LAMMPS does without MPI's C++ bindings, and their symbols must not come in through us
set(MPI_CXX_SKIP_MPICXX TRUE CACHE BOOL "Skip MPI C++ bindings" FORCE)
find_package(MPI REQUIRED COMPONENTS CXX)

# What every file that includes a LAMMPS header needs. MPI's headers only: its library comes with the host.
add_library(lammps_headers INTERFACE)
target_include_directories(lammps_headers SYSTEM INTERFACE
                           "${LAMMPS_SOURCE_DIR}/src" "${LAMMPS_SOURCE_DIR}/src/GRANULAR"
                           "${LAMMPS_SOURCE_DIR}/src/PLUGIN" ${MPI_CXX_INCLUDE_DIRS})
target_compile_definitions(lammps_headers INTERFACE ${MPI_CXX_COMPILE_DEFINITIONS})

# build/bin/lmp, beside lmp-dust: where tests and users look for the stock LAMMPS
if(EXISTS "${LAMMPS_PREFIX}/bin/lmp")
  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/bin")
  file(CREATE_LINK "${LAMMPS_PREFIX}/bin/lmp" "${CMAKE_BINARY_DIR}/bin/lmp" SYMBOLIC)
endif()
