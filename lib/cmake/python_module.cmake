# Finds what the Python module needs. If Debian's interpreter is installed, it is used, because
# Debian's packages (pybind11, numpy) belong to it.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3)
endif()
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
set(PYBIND11_NOPYTHON ON)
find_package(pybind11 2.10 QUIET)
set(AYUMI_PYTHON_FOUND OFF)
if(Python_FOUND AND pybind11_FOUND)
  set(AYUMI_PYTHON_FOUND ON)
else()
  message(STATUS "Python module: not built, it needs python3-dev and pybind11-dev")
endif()
