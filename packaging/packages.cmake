# packages.cmake: what `cpack` makes: Debian packages, by CPack's DEB generator, one for each component of the install
# rules:
#
#   psplat         the program, its manual, scenes, completions, schema, MIME type
#   psplat-mpi     the module of `psplat render --mpi`, where there is an MPI: so that psplat does not depend on it
#   libpsplat0     the library, and the plugins, which library and program share
#   libpsplat-dev  headers, pkg-config file, libpsplat(3), examples
#   psplat-doc     README and docs/
#
# They are for a configuration with -DCMAKE_INSTALL_PREFIX=/usr. Under Debian that makes lib/TRIPLET the folder of
# libraries; packages of other configurations are installed under /usr all the same, with libraries where the
# configuration had them. `debian/` and debhelper would need a source package, and root or a chroot to build in.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME psplat)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "psplat maintainers <maintainers@users.noreply.h-seed-3fd25a54.example>"
    CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program library development documentation)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/stage.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 0psplat1) # before 1, which would be Debian's own
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(debian_version ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})

# debian_package(COMPONENT NAME SECTION SUMMARY TEXT): the first line of the description, and the others.
function(debian_package component name section summary text)
  string(TOUPPER ${component} upper)
  set(prefix CPACK_DEBIAN_${upper}_PACKAGE)
  set(${prefix}_NAME ${name} PARENT_SCOPE)
  set(${prefix}_SECTION ${section} PARENT_SCOPE)
  set(${prefix}_PRIORITY optional PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}\n${text}" PARENT_SCOPE)
endfunction()

set(method
    "psplat renders still pictures of scenes in which light is reflected from
surface to surface, by photon splatting and, to compare, by path tracing,
photon mapping, radiosity and others.")

debian_package(program psplat graphics "offline renderer for indirect illumination"
               "${method}\n\nThis package has the program and scenes to try it with.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libpsplat0 (= ${debian_version})") # the plugins
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "psplat-doc")

debian_package(library libpsplat0 libs "offline renderer for indirect illumination (library)"
               "${method}\n\nThis package has the shared library, and the plugins that it and the
program use.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
configure_file(${CMAKE_CURRENT_LIST_DIR}/shlibs.in ${CMAKE_BINARY_DIR}/packaging/shlibs @ONLY)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${CMAKE_BINARY_DIR}/packaging/shlibs"
                                               "${CMAKE_CURRENT_LIST_DIR}/triggers")

debian_package(development libpsplat-dev libdevel "offline renderer for indirect illumination (development)"
               "${method}\n\nThis package has the headers of the library and of the interface of
plugins, and examples.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libpsplat0 (= ${debian_version})")

debian_package(documentation psplat-doc doc "offline renderer for indirect illumination (documentation)"
               "${method}\n\nThis package has the method, comparisons and measurements.")
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)

if(MPI_C_FOUND)
  list(APPEND CPACK_COMPONENTS_ALL mpi)
  debian_package(mpi psplat-mpi graphics "offline renderer for indirect illumination (MPI)"
                 "${method}\n\nThis package has the module by which processes on several machines
share a render.")
  set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "psplat (= ${debian_version})")
  string(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ", psplat-mpi")
endif()

include(CPack)
