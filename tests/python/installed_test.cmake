# SPDX-License-Identifier: Apache-2.0
# The module as `cmake --install` puts it: it finds its library, and the library its programs.
set(place ${BUILD}/tests/python/installed)
file(REMOVE_RECURSE ${place})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${place} RESULT_VARIABLE result OUTPUT_QUIET
    ERROR_VARIABLE output)
if(result)
    message(FATAL_ERROR "install: ${output}")
endif()
set(ENV{PYTHONPATH} ${place}/${MODULES})
set(ENV{PATH} /usr/bin:/bin)
execute_process(COMMAND ${PYTHON} -B -c "
import lamina, numpy
assert lamina.__file__.startswith('${place}'), lamina.__file__
z, y, x = numpy.mgrid[0:1:8j, 0:1:8j, 0:1:8j].astype(numpy.float32)
volume = lamina.Volume(x * y + z)
assert lamina.render(volume, size=(16, 12)).array.shape == (12, 16, 4)
assert 'liblamina.so' in open('/proc/self/maps').read()
if ${TETGEN}:
    assert lamina.mesh(volume, 0.1).report['within_tolerance']
" RESULT_VARIABLE result ERROR_VARIABLE output)
if(result)
    message(FATAL_ERROR "${output}")
endif()
