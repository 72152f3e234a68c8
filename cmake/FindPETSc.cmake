# PETSc in real double precision as the imported target PETSc::PETSc, with the MPI that it is built on; where it was
# built with Trilinos' ML, that library too, as PETSc::ML.
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
  pkg_check_modules(PETSC QUIET PETSc>=3.17)
endif()
find_path(PETSC_INCLUDE_DIR petscksp.h HINTS ${PETSC_INCLUDE_DIRS})
find_library(PETSC_LIBRARY NAMES ${PETSC_LIBRARIES} petsc HINTS ${PETSC_LIBRARY_DIRS})
find_package(MPI QUIET COMPONENTS C)
mark_as_advanced(PETSC_INCLUDE_DIR PETSC_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(
  PETSc
  REQUIRED_VARS PETSC_LIBRARY PETSC_INCLUDE_DIR MPI_C_FOUND
  VERSION_VAR PETSC_VERSION)

if(PETSc_FOUND AND NOT TARGET PETSc::PETSc)
  add_library(PETSc::PETSc UNKNOWN IMPORTED)
  set_target_properties(PETSc::PETSc PROPERTIES IMPORTED_LOCATION ${PETSC_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES
                                                                                   ${PETSC_INCLUDE_DIR})
  target_link_libraries(PETSc::PETSc INTERFACE MPI::MPI_C)
  include(CheckSymbolExists)
  set(CMAKE_REQUIRED_INCLUDES ${PETSC_INCLUDE_DIR})
  check_symbol_exists(PETSC_HAVE_ML petscconf.h PETSC_HAS_ML)
  unset(CMAKE_REQUIRED_INCLUDES)
  find_library(PETSC_ML_LIBRARY NAMES trilinos_ml ml)
  mark_as_advanced(PETSC_ML_LIBRARY)
  if(PETSC_HAS_ML AND PETSC_ML_LIBRARY)
    add_library(PETSc::ML UNKNOWN IMPORTED)
    set_target_properties(PETSc::ML PROPERTIES IMPORTED_LOCATION ${PETSC_ML_LIBRARY})
  endif()
endif()
