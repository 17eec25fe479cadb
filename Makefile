# SPDX-License-Identifier: GPL-3.0-or-later
# Needs Python 3.11 with venv, GCC, CMake and make; the rest is fetched once and kept under .venv and wheels.

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' blender_manifest.toml)
# For Linux as the machine's own compiler builds it, which is quick; `make package` builds what users get.
ZIP := build/photon_maps-$(VERSION)-linux-x64.zip
PLATFORMS := linux-x64 windows-x64 macos-arm64 macos-x64
PACKAGES := $(PLATFORMS:%=dist/photon_maps-$(VERSION)-%.zip)
PYTHON := .venv/bin/python
ZIG := $(CURDIR)/.venv/lib/python3.11/site-packages/ziglang/zig
PIP := $(PYTHON) -m pip --quiet --disable-pip-version-check
JOBS := $(shell nproc 2>/dev/null || getconf _NPROCESSORS_ONLN)
# The Embree that the wheel brings; a pattern, for the name carries a checksum.
EMBREE := $(CURDIR)/build/native/embreex.libs/libembree4-*.so.4

NATIVE_WHEEL := wheels/photon_maps_native-$(VERSION)-py3-none-manylinux_2_34_x86_64.whl
EMBREEX := wheels/embreex-4.4.0.post1

# What each package is built for, and how its wheels are called: the native one, and Embree's as published.
TARGET_linux-x64 := x86_64-linux-gnu.2.28
TARGET_windows-x64 := x86_64-windows-gnu
TARGET_macos-arm64 := aarch64-macos.11.0
TARGET_macos-x64 := x86_64-macos.11.0
TAG_linux-x64 := manylinux_2_28_x86_64
TAG_windows-x64 := win_amd64
TAG_macos-arm64 := macosx_11_0_arm64
TAG_macos-x64 := macosx_11_0_x86_64
EMBREEX_TAG_linux-x64 := manylinux_2_27_x86_64.manylinux_2_28_x86_64
EMBREEX_TAG_windows-x64 := win_amd64
EMBREEX_TAG_macos-arm64 := macosx_13_0_arm64
EMBREEX_TAG_macos-x64 := macosx_13_0_x86_64
native_wheel = wheels/photon_maps_native-$(VERSION)-py3-none-$(TAG_$(1)).whl
# The Pythons of official Blenders; on Linux also the one with which distributions build Blender 5.2.
PYTHONS = 3.11 3.13 $(if $(filter linux-%,$(1)),3.14)
cpython = cp$(subst .,,$(1))
embreex_wheels = $(foreach python,$(PYTHONS),$(EMBREEX)-$(call cpython,$(python))-$(call cpython,$(python))-$(EMBREEX_TAG_$(1)).whl)
EMBREEX_WHEELS := $(call embreex_wheels,linux-x64)

# Folders are among the sources, so that a file that went away counts as a change.
NATIVE_SOURCES := $(shell find engine/native -not -path 'engine/native/tests*' -not -path '*/__pycache__*')
EXTENSION_SOURCES := blender_manifest.toml LICENSE __init__.py \
    $(shell find licenses engine operators ui \( -type d -o -name '*.py' -o -name '*.txt' \) -not -path 'engine/native*' -not -path '*/__pycache__*')
PYTHON_FOLDERS := __init__.py engine operators ui tests tools benchmarks
CXX_SOURCES = $(shell find engine/native benchmarks -name '*.cpp' -o -name '*.h' -o -name '*.c')

MAKEFLAGS += --no-print-directory
export CMAKE_GENERATOR := Unix Makefiles
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
export SOURCE_DATE_EPOCH := 315532800
export PYTHONDONTWRITEBYTECODE := 1
unexport PYTHONPATH PYTHONHOME

# What is asked of `make demo`, `make beside` and `make chart`: by way of the environment, so that any file name will do.
export BLEND OUT FRAME SIZE CPU_SECONDS SECONDS SCENE METHOD LIMIT

.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help demo beside seed chart limits prediction calibration scale sweep package package-twice \
    $(PLATFORMS:%=package-twice-%) test built-checks test-native test-python test-gui test-versions test-first-render \
    test-wine test-here test-campaign soak mutate lint format bench growth docs clean

help:
	@echo 'make demo      render a picture: [BLEND=file.blend] [OUT=picture.png] [FRAME=1] [SIZE=50%]'
	@echo 'make beside    beside Cycles in the same CPU time: [BLEND=file.blend] [OUT=picture.png] [CPU_SECONDS=120]'
	@echo 'make test      style, C++ checks (also under sanitizers), Python and Blender tests'
	@echo 'make test-gui  the rendered viewport in the window of a real Blender, 1.3 GB in build the first time; needs root'
	@echo 'make test-campaign   the tests that take long: furnaces, invariances, and comparisons with Cycles'
	@echo 'make test-versions   the package in every Blender from 4.2 to 5.2 that is a Python module, 1.4 GB the first time'
	@echo 'make test-first-render   install and F12 in the oldest Blender, the newest, and 5.0'
	@echo 'make test-here the C++ checks on any system, by its compiler: HERE=python (with numpy and embreex)'
	@echo 'make test-wine the packages of the other platforms: under wine, on older processors, and by their headers'
	@echo 'make soak      what takes long to break: random calls under sanitizers, many renders, [SOAK_SECONDS=600] each'
	@echo 'make mutate    break the program in some hundred places, one at a time, and see that a test notices'
	@echo 'make bench     how far ahead, beside Mitsuba and Cycles, and what each part takes, 10 minutes: [DOCUMENTS=1]'
	@echo '               [LEAD="--scenes cornell --repetitions 1"]; then the speed of the export and the viewport'
	@echo 'make growth    time and memory by photons, triangles, lamps and pixels: [GROWTH=--large] [DOCUMENTS=1]'
	@echo 'make chart     error against CPU time, all methods and Cycles, 30 minutes: [SCENE=gap] [METHOD="final gather"]'
	@echo '               for a scene of yours: BLEND=file.blend [OUT=picture.png] [SECONDS=60]'
	@echo '               [PEERS=1] beside Mitsuba and LuxCore too, [DOCUMENTS=1] brings figures and tables into docs'
	@echo 'make prediction    the time that the chart of a scene foretells, over the true one: [PREDICTION="--scenes room"]'
	@echo 'make calibration   the error that renders estimate of themselves, over the true one: [CALIBRATION="--scenes gap"]'
	@echo 'make sweep     Automatic beside the best of many settings by hand, 45 minutes: [SWEEP="--scenes gap"]'
	@echo 'make scale     the time of scenes a thousand times smaller and larger: [SCALE="--scenes hall8"]'
	@echo 'make limits    how and how badly the method fails, 4 minutes: [LIMIT=leaks] [DOCUMENTS=1]'
	@echo 'make seed      repeat the experiment of the course report: scene, figures and tables in build/seed'
	@echo 'make package   the extension for Blender on Linux, Windows and macOS, in dist'
	@echo 'make docs      all pages as one site in build/docs, links checked'
	@echo 'make package-twice    the helpers built again in another folder: the same bytes'
	@echo 'make format    bring all sources into the project style'
	@echo 'make clean     remove build, dist and wheels; .venv stays'

# --- Environment: each stamp is made again when the file it was made from changes ---

.venv/bin/python:
	python3.11 -m venv .venv

.venv/build.stamp: requirements/build.txt | .venv/bin/python
	$(PIP) install -r requirements/build.txt
	@touch $@

.venv/test.stamp: requirements/test.txt .venv/build.stamp
	$(PIP) install -r requirements/test.txt
	@touch $@

.venv/package.stamp: requirements/package.txt .venv/build.stamp
	$(PIP) install -r requirements/package.txt
	@touch $@

.venv/seed.stamp: requirements/seed.txt .venv/build.stamp
	$(PIP) install -r requirements/seed.txt
	@touch $@

.venv/chart.stamp: requirements/chart.txt .venv/seed.stamp
	$(PIP) install -r requirements/chart.txt
	@touch $@

.venv/docs.stamp: requirements/docs.txt .venv/build.stamp
	$(PIP) install -r requirements/docs.txt
	@touch $@

# Without what they ask for but do not need here: CUDA, and another version of what there is.
.venv/peers.stamp: requirements/peers.txt .venv/build.stamp
	$(PIP) install --no-deps -r requirements/peers.txt
	@[ -n "$$(find /usr/lib -name 'libLLVM.so.19*' -print -quit)" ] || bash tools/apt_install.sh libllvm19 || \
	    echo 'Without libllvm19 Mitsuba runs in its scalar variant only.'
	@touch $@

.venv/system.stamp: tools/system_libraries.sh .venv/build.stamp
	bash tools/system_libraries.sh .venv
	@touch $@

# --- Wheels: the native helper, and Embree as published ---

$(NATIVE_WHEEL): $(NATIVE_SOURCES) .venv/build.stamp
	@mkdir -p build wheels
	$(PIP) wheel --no-build-isolation --no-deps --no-index \
	    -C build-dir=$(CURDIR)/build/cmake/release -w wheels ./engine/native
	@touch $@

# Builds the native wheel of a platform; from a folder, in a folder, into a folder.
build_native = $(PIP) wheel --no-build-isolation --no-deps --no-index \
    -C build-dir=$(CURDIR)/$(3) -C wheel.tags=py3-none-$(TAG_$(1)) \
    -C cmake.define.CMAKE_TOOLCHAIN_FILE=$(CURDIR)/$(2)/zig.cmake \
    -C cmake.define.ZIG_COMPILER=$(ZIG) -C cmake.define.ZIG_TARGET=$(TARGET_$(1)) -w $(4) ./$(2)

# How each platform gets its wheels, and the package of them.
define platform_rules
$(call embreex_wheels,$(1)) &: requirements/bundled.txt | .venv/build.stamp
	@for version in $(PYTHONS); do \
	    $(PIP) download --no-deps --require-hashes --only-binary :all: --python-version $$$$version \
	        --platform $(lastword $(subst ., ,$(EMBREEX_TAG_$(1)))) --dest wheels -r requirements/bundled.txt || exit 1; \
	done
	@touch $(call embreex_wheels,$(1))

$(call native_wheel,$(1)): $(NATIVE_SOURCES) .venv/package.stamp
	@mkdir -p build wheels
	$(call build_native,$(1),engine/native,build/cmake/$(1),wheels)
	@touch $$@

# In another folder, the same bytes.
package-twice-$(1): $(call native_wheel,$(1))
	@rm -rf build/twice/$(1)
	@mkdir -p build/twice/$(1)
	@cp -r engine/native build/twice/$(1)/source
	$(call build_native,$(1),build/twice/$(1)/source,build/twice/$(1)/cmake,build/twice/$(1))
	cmp build/twice/$(1)/$(notdir $(call native_wheel,$(1))) $(call native_wheel,$(1))

dist/photon_maps-$(VERSION)-$(1).zip: $(call native_wheel,$(1)) $(call embreex_wheels,$(1)) $(EXTENSION_SOURCES) \
    tools/package.py | .venv/build.stamp
	$(PYTHON) tools/package.py --platform $(1) --output $$@
endef
$(foreach platform,$(PLATFORMS),$(eval $(call platform_rules,$(platform))))

# What the wheels hold, for tests without Blender: beside .venv, so that Blender finds what it installed itself.
build/native/stamp: $(NATIVE_WHEEL) $(firstword $(EMBREEX_WHEELS))
	rm -rf build/native build/native.new
	$(PIP) install --no-deps --no-index --target build/native.new $^
	mv build/native.new build/native
	@touch $@

# --- The extension ---

package: $(PACKAGES)
	@echo 'Install one in Blender by Edit > Preferences > Get Extensions > Install from Disk.'

package-twice: $(PLATFORMS:%=package-twice-%)

$(ZIP): $(NATIVE_WHEEL) $(EMBREEX_WHEELS) $(EXTENSION_SOURCES) tools/package.py | .venv/build.stamp
	$(PYTHON) tools/package.py --platform linux-x64 --native $(NATIVE_WHEEL) --output $@

demo: $(ZIP) .venv/system.stamp
	@$(PYTHON) tools/render.py --extension $(ZIP) --blend "$$BLEND" --out "$$OUT" --frame "$$FRAME" --size "$$SIZE"

beside: $(ZIP) .venv/system.stamp
	@$(PYTHON) tools/beside_cycles.py --extension $(ZIP) --blend "$$BLEND" --out "$$OUT" --seconds "$$CPU_SECONDS"

# Draws build/chart/calibration.png of docs/error.md.
calibration: build/native/stamp .venv/chart.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.calibration_bench $(CALIBRATION)

scale: build/native/stamp .venv/chart.stamp .venv/test.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.scale_bench $(SCALE)

sweep: build/native/stamp .venv/chart.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.sweep_bench $(SWEEP)

# Draws build/chart/prediction.png: docs/images/prediction.png.
prediction: build/native/stamp .venv/chart.stamp .venv/system.stamp
	PYTHONPATH=.:build/native $(PYTHON) -m benchmarks.prediction_bench $(PREDICTION)

# The scene, figures and tables of docs/seed.md; the path-traced reference is kept there from run to run.
seed: build/native/stamp .venv/seed.stamp .venv/system.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.seed.reproduce  # it has threads of its own

# The figures and tables of docs/chart.md and docs/method.md; what is measured is kept there from run to run.
ifeq ($(BLEND),)
chart: build/native/stamp .venv/chart.stamp .venv/system.stamp $(if $(PEERS),.venv/peers.stamp)
	@PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.chart \
	    --scene "$$SCENE" --method "$$METHOD" $(if $(DOCUMENTS),--documents)
else
chart: $(ZIP) .venv/system.stamp
	@$(PYTHON) tools/chart_scene.py --extension $(ZIP) --blend "$$BLEND" --out "$$OUT" --seconds "$$SECONDS"
endif

# How and how badly the method fails: figures and tables of docs/limits.md.
limits: build/native/stamp .venv/chart.stamp .venv/test.stamp
	@PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.limits \
	    --limit "$$LIMIT" $(if $(DOCUMENTS),--documents)

# --- Checks ---

CTEST = ctest --test-dir build/cmake/$(1) --parallel $(JOBS) --output-on-failure --no-tests=error
WITHOUT_BLENDER := --ignore=tests/blender --ignore=tests/gui --ignore=tests/versions --ignore=tests/platforms
PYTEST := timeout 1500 $(PYTHON) -m pytest tests $(WITHOUT_BLENDER) --numprocesses 2 --dist loadfile
# There without build/native: the wheels are the zip's.
PYTEST_IN_BLENDER := timeout 1500 $(PYTHON) -m pytest tests/blender -o pythonpath=.
TEST_PYTHON_NEEDS := .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)

# The parts of test-native and test-python, side by side: most of them keep one core busy.
test: lint built-checks $(TEST_PYTHON_NEEDS)
	@bash tools/side_by_side.sh '$(call CTEST,release) && $(PYTEST)' '$(PYTEST_IN_BLENDER)' '$(call CTEST,sanitize)'

lint: .venv/test.stamp
	.venv/bin/ruff check $(wildcard $(PYTHON_FOLDERS))
	.venv/bin/ruff format --check $(wildcard $(PYTHON_FOLDERS))
	@.venv/bin/clang-format --dry-run -Werror $(CXX_SOURCES)

format: .venv/test.stamp
	.venv/bin/ruff format $(wildcard $(PYTHON_FOLDERS))
	.venv/bin/ruff check --fix $(wildcard $(PYTHON_FOLDERS))
	.venv/bin/ruff format $(wildcard $(PYTHON_FOLDERS))
	@.venv/bin/clang-format -i $(CXX_SOURCES)

# The release build is the one the wheel was made from.
built-checks: build/native/stamp
	cmake -S engine/native -B build/cmake/release -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE))
	cmake -S engine/native -B build/cmake/sanitize -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) \
	    -DPHOTON_MAPS_SANITIZE=ON -DCMAKE_CXX_FLAGS_RELEASE=-O1
	@for kind in release sanitize; do cmake --build build/cmake/$$kind || exit 1; done

# The same checks by the compiler of any system, for its release: HERE names the Python there, which has embreex.
test-here:
	embree="$$(PYTHONPATH=engine/native \
	    $(HERE) -c 'from photon_maps_native.library import embree_path; print(embree_path().as_posix(), end="")')" && \
	cmake -S engine/native -B build/cmake/here -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE="$$embree"
	cmake --build build/cmake/here
	@$(call CTEST,here)

test-native: built-checks
	@$(call CTEST,release)
	@$(call CTEST,sanitize)

test-python: $(TEST_PYTHON_NEEDS)
	@bash tools/side_by_side.sh '$(PYTEST)' '$(PYTEST_IN_BLENDER)'

# BLENDER_ROOT: a folder that holds another Blender, made by `bash tests/gui/blender.sh FOLDER sid`.
test-gui: .venv/test.stamp dist/photon_maps-$(VERSION)-linux-x64.zip
	@mkdir -p build
	bash tests/gui/blender.sh "$${BLENDER_ROOT:-build/blender-trixie}"
	timeout 3000 $(PYTHON) -m pytest tests/gui -o pythonpath=.

# One environment for each Blender that is a Python module. BLENDER_ROOT: folders of applications besides, as
# for test-gui, with colons between them.
VERSIONS := 4.2.23 4.5.15 5.0.1 5.2.3
PYTHON_OF_4.2.23 := 3.11
PYTHON_OF_4.5.15 := 3.11
PYTHON_OF_5.0.1 := 3.11
PYTHON_OF_5.2.3 := 3.13

build/versions/%/stamp: requirements/blender_%.txt tools/find_python.sh
	rm -rf $(@D)
	"$$(bash tools/find_python.sh $(PYTHON_OF_$*))" -m venv $(@D)
	$(@D)/bin/python -m pip --quiet --disable-pip-version-check install -r $<
	@touch $@

test-versions: .venv/test.stamp .venv/system.stamp dist/photon_maps-$(VERSION)-linux-x64.zip \
    $(VERSIONS:%=build/versions/%/stamp)
	$(PYTHON) -m pytest tests/versions/test_versions.py -o pythonpath=.

# What of it costs a minute or two: the package of this machine's compiler in the oldest Blender and the newest.
test-first-render: $(TEST_PYTHON_NEEDS) build/versions/4.2.23/stamp build/versions/5.2.3/stamp
	$(PYTHON) -m pytest tests/versions/test_first_render.py -o pythonpath=.

# The program that repeats recorded calls, for the oldest processors of each platform.
REPLAY_SOURCES := engine/native/replay/replay.cpp engine/native/src/dynamic_library.cpp
build/replay/replay: TARGET := $(TARGET_linux-x64)
build/replay/replay.exe: TARGET := $(TARGET_windows-x64) -mcpu=x86_64_v2 -s  # as its library: built from the same parts
build/replay/replay build/replay/replay.exe: $(REPLAY_SOURCES) engine/native/src/dynamic_library.h .venv/package.stamp
	@mkdir -p $(@D)
	$(ZIG) c++ -target $(TARGET) -std=c++20 -O3 -Iengine/native/src $(REPLAY_SOURCES) -o $@

# The checks of what is vectorized.
VECTORIZED := test_photon_map test_filter test_estimate test_nested_estimate test_many_lamps

# Wine stands for Windows, qemu for processors without AVX2, for those without AVX-512, and for ARM with its NEON.
test-wine: .venv/test.stamp build/native/stamp build/replay/replay build/replay/replay.exe $(PACKAGES)
	@[ -x /usr/lib/wine/wine64 ] && command -v qemu-x86_64 >/dev/null || bash tools/apt_install.sh wine64 qemu-user
	timeout 1800 $(PYTHON) -m pytest tests/platforms
	cmake -S engine/native -B build/cmake/release -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE))
	cmake --build build/cmake/release --target $(VECTORIZED)
	@for check in $(VECTORIZED); do \
	    for processor in Nehalem Haswell; do \
	        echo "$$check on $$processor"; \
	        PHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) qemu-x86_64 -cpu $$processor build/cmake/release/$$check || exit 1; \
	    done; \
	done
	cmake -S engine/native -B build/cmake/arm -DPHOTON_MAPS_TESTS=ON -DZIG_COMPILER=$(ZIG) -DZIG_TARGET=aarch64-linux-musl \
	    -DCMAKE_TOOLCHAIN_FILE=$(CURDIR)/engine/native/zig.cmake
	cmake --build build/cmake/arm --target $(VECTORIZED)
	@for check in $(VECTORIZED); do echo "$$check on ARM"; qemu-aarch64 build/cmake/arm/$$check || exit 1; done

test-campaign: .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)
	$(PYTHON) -m pytest tests $(WITHOUT_BLENDER) -m campaign
	$(PYTHON) -m pytest tests/blender -o pythonpath=. -m campaign

# Random calls under the sanitizers, one render under that of threads, and many renders, passes and viewports.
SOAK_SECONDS := 600
SOAKED := test_fuzz test_call_order
soak: .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)
	cmake -S engine/native -B build/cmake/sanitize -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) \
	    -DPHOTON_MAPS_SANITIZE=ON -DCMAKE_CXX_FLAGS_RELEASE=-O1
	cmake -S engine/native -B build/cmake/threads -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) \
	    -DPHOTON_MAPS_SANITIZE_THREADS=ON -DCMAKE_CXX_FLAGS_RELEASE=-O1
	cmake --build build/cmake/sanitize --target $(SOAKED)
	cmake --build build/cmake/threads --target test_api
	@for check in $(SOAKED); do \
	    echo "== $$check"; \
	    ASAN_OPTIONS=detect_leaks=0 PHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) \
	        build/cmake/sanitize/$$check $$(date +%s) $(SOAK_SECONDS) || exit 1; \
	done
	@# Embree and its threads are as published: what happens in there is not seen.
	@echo '== threads'
	TSAN_OPTIONS=suppressions=engine/native/tests/threads.supp PHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) build/cmake/threads/test_api
	$(PYTHON) -m pytest tests $(WITHOUT_BLENDER) -m soak
	$(PYTHON) -m pytest tests/blender -o pythonpath=. -m soak

# What was found is kept in build/mutate until the mutated file or its tests change: [MUTATE="--only lamp"]
mutate: .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)
	$(PYTHON) tools/mutate.py $(MUTATE)

# The tables of docs/speed.md: how much sooner to an error than others, and what each part takes.
bench: build/native/stamp .venv/chart.stamp .venv/system.stamp .venv/peers.stamp
	@[ -e /usr/include/nanoflann.hpp ] || bash tools/apt_install.sh libnanoflann-dev
	cmake -S engine/native -B build/cmake/release -DPHOTON_MAPS_BENCHMARKS=ON
	cmake --build build/cmake/release
	@echo '== lead_bench'
	@PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.lead_bench \
	    $(LEAD) $(if $(DOCUMENTS),--documents)
	@PYTHONPATH=.:build/native PHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) $(PYTHON) -m benchmarks.parts_bench \
	    $(if $(DOCUMENTS),--documents) build/cmake/release/benchmarks/*_bench
	@PYTHONPATH=.:build/native $(PYTHON) -m benchmarks.gains $(if $(DOCUMENTS),--documents)
	@for script in export viewport; do \
	    echo "== $${script}_bench"; PYTHONPATH=.:build/native $(PYTHON) benchmarks/$${script}_bench.py || exit 1; \
	done

# The curves of docs/speed.md.
growth: build/native/stamp .venv/chart.stamp
	@PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.growth_bench \
	    $(GROWTH) $(if $(DOCUMENTS),--documents)

# What warns, such as a link that leads nowhere, fails; so does what a reader would fetch from elsewhere.
docs: .venv/docs.stamp
	@rm -rf build/docs
	@NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --strict
	@! grep -rlE '<(script|link|img)[^>]* (src|href)="?http' build/docs --include='*.html' || \
	    { echo 'These pages fetch something from the network.' >&2; exit 1; }
	@echo 'The site is build/docs/index.html.'

clean:
	rm -rf build dist wheels
