# SPDX-License-Identifier: GPL-3.0-or-later
# Needs Python 3.11 with venv, GCC, CMake and make; the rest is fetched once and kept under .venv and wheels.

VERSION := $(shell sed -n 's/^version = "\(.*\)"/\1/p' blender_manifest.toml)
ZIP := dist/photon_maps-$(VERSION)-linux-x64.zip
PYTHON := .venv/bin/python
PIP := $(PYTHON) -m pip --quiet --disable-pip-version-check
JOBS := $(shell nproc)
# The Embree that the wheel brings; a pattern, for the name carries a checksum.
EMBREE := $(CURDIR)/build/native/embreex.libs/libembree4-*.so.4

NATIVE_WHEEL := wheels/photon_maps_native-$(VERSION)-py3-none-manylinux_2_34_x86_64.whl
EMBREEX := wheels/embreex-4.4.0.post1
EMBREEX_TAGS := manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl
EMBREEX_WHEELS := $(EMBREEX)-cp311-cp311-$(EMBREEX_TAGS) $(EMBREEX)-cp313-cp313-$(EMBREEX_TAGS)

# Folders are among the sources, so that a file that went away counts as a change.
NATIVE_SOURCES := $(shell find engine/native -not -path 'engine/native/tests*' -not -path '*/__pycache__*')
EXTENSION_SOURCES := blender_manifest.toml LICENSE __init__.py \
    $(shell find engine operators ui \( -type d -o -name '*.py' \) -not -path 'engine/native*' -not -path '*/__pycache__*')
PYTHON_FOLDERS := __init__.py engine operators ui tests tools benchmarks
CXX_SOURCES = $(shell find engine/native benchmarks -name '*.cpp' -o -name '*.h' -o -name '*.c')

MAKEFLAGS += --no-print-directory
export CMAKE_GENERATOR := Unix Makefiles
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
export SOURCE_DATE_EPOCH := 315532800
export PYTHONDONTWRITEBYTECODE := 1
unexport PYTHONPATH PYTHONHOME

# What is asked of `make demo`, `make beside` and `make chart`: by way of the environment, so that any file name will do.
export BLEND OUT FRAME SIZE CPU_SECONDS SECONDS SCENE METHOD

.DELETE_ON_ERROR:
.NOTPARALLEL:
.PHONY: help demo beside seed chart prediction calibration sweep package test test-native test-python test-gui \
    test-campaign lint format bench clean

help:
	@echo 'make demo      render a picture: [BLEND=file.blend] [OUT=picture.png] [FRAME=1] [SIZE=50%]'
	@echo 'make beside    beside Cycles in the same CPU time: [BLEND=file.blend] [OUT=picture.png] [CPU_SECONDS=120]'
	@echo 'make test      style, C++ checks (also under sanitizers), Python and Blender tests'
	@echo 'make test-gui  the rendered viewport in the window of a real Blender, 1.3 GB in build the first time; needs root'
	@echo 'make test-campaign   the tests that take long: furnaces, invariances, and comparisons with Cycles'
	@echo 'make bench     speed of the photon map, the photon pass, the export and the viewport'
	@echo 'make chart     error against CPU time, all methods and Cycles, 30 minutes: [SCENE=gap] [METHOD="final gather"]'
	@echo '               for a scene of yours: BLEND=file.blend [OUT=picture.png] [SECONDS=60]'
	@echo '               [PEERS=1] beside Mitsuba and LuxCore too, [DOCUMENTS=1] brings figures and tables into docs'
	@echo 'make prediction    the time that the chart of a scene foretells, over the true one: [PREDICTION="--scenes room"]'
	@echo 'make calibration   the error that renders estimate of themselves, over the true one: [CALIBRATION="--scenes gap"]'
	@echo 'make sweep     Automatic beside the best of many settings by hand: [SWEEP="--scenes gap"]'
	@echo 'make seed      repeat the experiment of the course report: scene, figures and tables in build/seed'
	@echo 'make package   the extension for Blender: $(ZIP)'
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

.venv/seed.stamp: requirements/seed.txt .venv/build.stamp
	$(PIP) install -r requirements/seed.txt
	@touch $@

.venv/chart.stamp: requirements/chart.txt .venv/seed.stamp
	$(PIP) install -r requirements/chart.txt
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

$(EMBREEX_WHEELS) &: requirements/bundled.txt | .venv/build.stamp
	@for version in 3.11 3.13; do \
	    $(PIP) download --no-deps --require-hashes --only-binary :all: --python-version $$version \
	        --platform manylinux_2_28_x86_64 --dest wheels -r requirements/bundled.txt || exit 1; \
	done
	@touch $(EMBREEX_WHEELS)

# What the wheels hold, for tests without Blender: beside .venv, so that Blender finds what it installed itself.
build/native/stamp: $(NATIVE_WHEEL) $(firstword $(EMBREEX_WHEELS))
	rm -rf build/native build/native.new
	$(PIP) install --no-deps --no-index --target build/native.new $^
	mv build/native.new build/native
	@touch $@

# --- The extension ---

package: $(ZIP)
	@echo 'Install it in Blender by Edit > Preferences > Get Extensions > Install from Disk: $(ZIP)'

$(ZIP): $(EXTENSION_SOURCES) $(NATIVE_WHEEL) $(EMBREEX_WHEELS) tools/package.py | .venv/build.stamp
	$(PYTHON) tools/package.py --output $@

demo: $(ZIP) .venv/system.stamp
	@$(PYTHON) tools/render.py --extension $(ZIP) --blend "$$BLEND" --out "$$OUT" --frame "$$FRAME" --size "$$SIZE"

beside: $(ZIP) .venv/system.stamp
	@$(PYTHON) tools/beside_cycles.py --extension $(ZIP) --blend "$$BLEND" --out "$$OUT" --seconds "$$CPU_SECONDS"

# Draws build/chart/calibration.png of docs/error.md.
calibration: build/native/stamp .venv/chart.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.calibration_bench $(CALIBRATION)

sweep: build/native/stamp .venv/chart.stamp
	PYTHONPATH=.:build/native OPENBLAS_NUM_THREADS=1 $(PYTHON) -m benchmarks.sweep_bench $(SWEEP)

prediction: build/native/stamp .venv/test.stamp .venv/system.stamp
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

# --- Checks ---

test: lint test-native test-python

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
test-native: build/native/stamp
	cmake -S engine/native -B build/cmake/release -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE))
	cmake -S engine/native -B build/cmake/sanitize -DPHOTON_MAPS_TESTS=ON -DPHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) \
	    -DPHOTON_MAPS_SANITIZE=ON -DCMAKE_CXX_FLAGS_RELEASE=-O1
	@for kind in release sanitize; do \
	    cmake --build build/cmake/$$kind && \
	    ctest --test-dir build/cmake/$$kind --parallel $(JOBS) --output-on-failure --no-tests=error || exit 1; \
	done

WITHOUT_BLENDER := --ignore=tests/blender --ignore=tests/gui

test-python: .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)
	@# Side by side: those in Blender use one core most of the time. There without build/native: the wheels are the zip's.
	@mkdir -p build
	@timeout 900 $(PYTHON) -m pytest tests/blender -o pythonpath=. \
	    > build/tests_blender.log 2>&1 & blender=$$!; \
	timeout 900 $(PYTHON) -m pytest tests $(WITHOUT_BLENDER); native=$$?; \
	wait $$blender; in_blender=$$?; cat build/tests_blender.log; exit $$((native + in_blender))

# BLENDER_ROOT: a folder that holds another Blender, made by `bash tests/gui/blender.sh FOLDER sid`.
test-gui: .venv/test.stamp $(ZIP)
	@mkdir -p build
	bash tests/gui/blender.sh "$${BLENDER_ROOT:-build/blender-trixie}"
	timeout 3000 $(PYTHON) -m pytest tests/gui -o pythonpath=.

test-campaign: .venv/test.stamp .venv/system.stamp build/native/stamp $(ZIP)
	$(PYTHON) -m pytest tests $(WITHOUT_BLENDER) -m campaign
	$(PYTHON) -m pytest tests/blender -o pythonpath=. -m campaign

bench: build/native/stamp .venv/system.stamp
	@[ -e /usr/include/nanoflann.hpp ] || bash tools/apt_install.sh libnanoflann-dev
	cmake -S engine/native -B build/cmake/release -DPHOTON_MAPS_BENCHMARKS=ON
	cmake --build build/cmake/release
	@for program in build/cmake/release/benchmarks/*_bench; do \
	    echo "== $$(basename $$program)"; PHOTON_MAPS_EMBREE=$$(echo $(EMBREE)) $$program || exit 1; \
	done
	@for script in export viewport; do \
	    echo "== $${script}_bench"; PYTHONPATH=.:build/native $(PYTHON) benchmarks/$${script}_bench.py || exit 1; \
	done

clean:
	rm -rf build dist wheels
