# Packages of the files that `cmake --install` writes: `cpack -G DEB` makes ayumi, libayumi-dev,
# python3-ayumi and ayumi-doc. The components of the installation have the names of the packages.
# packaging/archive.sh makes the archive that runs without them.

set(AYUMI_MAINTAINER "Ayumi maintainers <maintainers@users.noreply.github.com>" CACHE STRING
    "Maintainer in the control files of the packages")
set(CPACK_PACKAGE_NAME ayumi)
set(CPACK_PACKAGE_VENDOR Ayumi)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # CPack would put it before the packages' own summaries
set(CPACK_PACKAGE_CONTACT "${AYUMI_MAINTAINER}")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_COMPONENTS_ALL ayumi libayumi-dev ayumi-doc)
if(TARGET ayumi_python)
  list(APPEND CPACK_COMPONENTS_ALL python3-ayumi)
endif()

# ayumi_package(component section summary lines...) sets the content of a package's control file.
function(ayumi_package component section summary)
  string(TOUPPER ${component} key)
  string(JOIN "\n" text ${summary} ${ARGN})
  foreach(pair "PACKAGE_NAME;${component}" "PACKAGE_SECTION;${section}" "DESCRIPTION;${text}")
    list(POP_FRONT pair name)
    set(CPACK_DEBIAN_${key}_${name} "${pair}" PARENT_SCOPE)
  endforeach()
endfunction()
ayumi_package(ayumi science "motion patterns of humanoid robots: check and stabilize"
  "Ayumi reads a robot and a motion pattern and says whether the motion is"
  "physically consistent. It finds the nearest motion that is, simulates the"
  "robot with a balance controller and disturbances, and writes joint tables.")
ayumi_package(libayumi-dev libdevel "library for motion patterns of humanoid robots"
  "Headers, static libraries and the CMake package with which C++ programs use"
  "the checks, the repair and the simulation of Ayumi.")
ayumi_package(python3-ayumi python "motion patterns of humanoid robots, for Python"
  "The checks, the repair, the simulation, the studies and the pictures of Ayumi"
  "as a Python package, with numpy arrays that have names and units.")
ayumi_package(ayumi-doc doc "pages of Ayumi, motion patterns of humanoid robots"
  "Tutorial, reference of the commands and of the file formats, and the theory of"
  "the checks and of the controllers.")

foreach(component AYUMI PYTHON3-AYUMI)
  set(CPACK_DEBIAN_${component}_PACKAGE_SHLIBDEPS ON)
endforeach()
# OSMesa is only loaded for the first picture, so that the packages' tool does not find it.
set(CPACK_DEBIAN_AYUMI_PACKAGE_DEPENDS fonts-dejavu-core)
if(OSMESA_FOUND)
  string(APPEND CPACK_DEBIAN_AYUMI_PACKAGE_DEPENDS ", libosmesa6")
endif()
set(CPACK_DEBIAN_AYUMI_PACKAGE_RECOMMENDS ffmpeg)
set(CPACK_DEBIAN_AYUMI_PACKAGE_SUGGESTS "ayumi-doc, python3-ayumi")
set(CPACK_DEBIAN_LIBAYUMI-DEV_PACKAGE_DEPENDS
    "ayumi (= ${PROJECT_VERSION}), libeigen3-dev, coinor-libipopt-dev, libceres-dev, liburdfdom-dev, libtinyxml-dev, \
nlohmann-json3-dev, libssl-dev, zlib1g-dev, libzstd-dev, libzip-dev, libyaml-cpp-dev, \
libosmesa6, libegl-dev, libjpeg62-turbo-dev, libcairo2-dev")
set(CPACK_DEBIAN_LIBAYUMI-DEV_PACKAGE_RECOMMENDS libmujoco-dev)
if(Python_FOUND)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON3-AYUMI_PACKAGE_DEPENDS
      "ayumi (= ${PROJECT_VERSION}), python3 (>= 3.${Python_VERSION_MINOR}~), \
python3 (<< 3.${next}~), python3-numpy")
endif()
set(CPACK_DEBIAN_AYUMI-DOC_PACKAGE_ARCHITECTURE all)

# Files that Debian's policy requires in the documentation folder of each package. SOURCE_DATE_EPOCH
# sets the date if two builds have to give the same bytes.
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(documents ${PROJECT_BINARY_DIR}/packaging)
foreach(package ${CPACK_COMPONENTS_ALL})
  file(WRITE ${documents}/${package}/changelog
       "${package} (${PROJECT_VERSION}) stable; urgency=medium\n\n"
       "  * CHANGELOG.md in the package ayumi-doc lists the changes.\n\n"
       " -- ${AYUMI_MAINTAINER}  ${date}\n")
  execute_process(COMMAND gzip -9nkf ${documents}/${package}/changelog COMMAND_ERROR_IS_FATAL ANY)
  install(FILES ${documents}/${package}/changelog.gz ${CMAKE_CURRENT_LIST_DIR}/copyright
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${package})
endforeach()
include(CPack)
