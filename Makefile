# make: set up and replicate everything. make test: linters and most tests. make help: all targets.
PYTHON ?= python3
CORES ?= 2
COUNT ?= 20
PORT ?= 9090
STUDY ?= replication
RESULTS = $(if $(filter replication,$(STUDY)),results,results/studies/$(STUDY))
STUDY_FILE = $(firstword $(wildcard $(STUDY).yaml workflow/studies/$(STUDY).yaml))
NO_SUCH = $(if $(filter replication,$(STUDY))$(STUDY_FILE),,$(error there is no $(STUDY).yaml; see docs/bend.md))
SNAKEMAKE = .venv/bin/snakemake --cores $(CORES) $(addprefix --configfile ,$(STUDY_FILE))
RECORDINGS = $(RESULTS)/recordings
RECORDING = $(firstword $(SCENARIO:%=$(RECORDINGS)/%.rrd) \
  $(wildcard $(RECORDINGS)/links_encoders.rrd $(RECORDINGS)/*.rrd) $(RECORDINGS)/links_encoders.rrd)
PIP = .venv/bin/python -m pip install --quiet --disable-pip-version-check
UV = .venv/bin/uv --quiet --no-python-downloads
PYTEST = .venv/bin/python -m pytest
LOCK = .venv/bin/uv pip compile pyproject.toml --universal --generate-hashes --no-emit-index-url \
  --python-version 3.11 --custom-compile-command "make lock"
# images of containers often forbid Python to keep what it compiled: each job would do it again
export PYTHONDONTWRITEBYTECODE =
ELSEWHERE = folder=$$(mktemp -d) && trap 'rm -r "$$folder"' EXIT

.PHONY: all help quick study setup tools cluster vision live lint lines test test-all dist elsewhere lowest slurm faults verify mutants peers check bench latency report article archive reproduce docs pictures view web notebook tune design power reference universes horizons ship lock clean

all: setup ## the full replication
	$(SNAKEMAKE)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' $(MAKEFILE_LIST) | tr '|' '\t' | expand -t 12

quick: STUDY = quick
quick: study ## a small replication, in two minutes with its set-up: results/studies/quick

study: setup ## a study of workflow/studies or of your own: make study STUDY=my_arm; see docs/bend.md
	$(NO_SUCH)
	@.venv/bin/python -m workflow.readable $(STUDY_FILE)
	$(SNAKEMAKE) --quiet rules reason host
	$(SNAKEMAKE) --quiet all --report $(RESULTS)/report.html --report-stylesheet workflow/report/style.css

setup: .venv/installed ## the environment of the studies, from requirements.lock

tools: .venv/tools ## what tests, pages and the article need besides, from requirements-dev.lock

.venv/installed: requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; (3, 11) <= sys.version_info < (3, 14) or sys.exit(f"$(PYTHON) is Python \
	{sys.version.split()[0]}; expected: 3.11 to 3.13; try: make PYTHON=python3.12")'
	$(PYTHON) -m venv .venv
	$(PIP) --require-hashes -r requirements.lock
	$(PIP) --no-index --no-build-isolation --no-deps --editable .
	touch $@

.venv/tools: .venv/installed requirements-dev.lock
	$(PIP) --require-hashes -r requirements-dev.lock
	touch $@

cluster: .venv/extras ## what Snakemake needs to talk to Slurm, from requirements-extras.lock; see docs/cluster.md

vision: .venv/extras ## OpenCV for pictures of a board, from requirements-extras.lock; see docs/pictures.md

live: .venv/extras ## MuJoCo for an arm with dynamics, from requirements-extras.lock; see docs/live_paper.md

.venv/extras: .venv/installed requirements-extras.lock
	$(PIP) --require-hashes -r requirements-extras.lock
	touch $@

test: lint ## the linters and all tests except whole workflows, examples, sites and environments
	$(PYTEST) -m "not slow"

test-all: lint ## the linters and all tests
	$(PYTEST)

lint: tools ## the linters and the types of the library
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy
	.venv/bin/snakefmt --check Snakefile workflow/rules

lines: ## count the lines of Python
	@echo "recalib and workflow: $$(git ls-files 'recalib/*.py' 'workflow/*.py' | xargs cat | wc -l)"
	@echo "tests: $$(git ls-files 'tests/*.py' | xargs cat | wc -l)"

dist: tools ## build what is released, the sources and the wheel, in dist/
	rm -rf dist
	.venv/bin/python -m build --no-isolation --outdir dist
	.venv/bin/twine check --strict dist/*

elsewhere: dist ## unpack the released sources elsewhere, and run make test and make quick there; PYTHON=python3.13 for another Python
	$(ELSEWHERE) && tar --extract --file dist/recalib-*.tar.gz --directory "$$folder" --strip-components 1 && \
	  make --directory "$$folder" PYTHON=$(PYTHON) test quick

lowest: tools ## the library's tests with the lowest versions that pyproject.toml allows
	$(ELSEWHERE) && $(UV) venv --python .venv/bin/python "$$folder" && \
	  $(UV) pip install --python "$$folder" --resolution lowest-direct .[laboratory,study,vision,dev] && \
	  "$$folder/bin/python" -m pytest -m "not slow" $(addprefix tests/,damaged identification laboratory learners nominal vision/test_boards.py vision/test_patterns.py)

slurm: tools ## run a small campaign on a Slurm cluster of one node, with faults; says what is missing for it
	.venv/bin/python -m pytest -n0 -rs tests/slurm

faults: tools ## kill runs, start two at once, damage files, fill the disk (10 minutes)
	.venv/bin/python -m pytest -n0 -vv -rs tests/faults

verify: setup ## remove results that have changed since they were written
	.venv/bin/python -m workflow.digests results

mutants: tools .venv/extras ## plant small random errors in the code, and list those that no test notices, with the time left: docs/mutants.md
	.venv/bin/python -m tests.mutants --count $(COUNT)

peers: tools ## compare our calibration with figaroh and robotkinecal, each in an environment of its own: docs/peers.md
	.venv/bin/python -m tests.peers $(addprefix --recording ,$(RECORDED))

check: setup ## only compare the final errors with their bands
	$(SNAKEMAKE) --forcerun check -- $(RESULTS)/check.txt

bench: setup ## measure moves per second, and their ratio to a bare loop
	$(SNAKEMAKE) --forcerun bench -- $(RESULTS)/bench.txt

latency: vision live ## measure how fast a live calibration answers, and a corrected command
	.venv/bin/python -m tests.station.latency

report: all ## write all results into one page, results/report.html
	$(SNAKEMAKE) --report $(RESULTS)/report.html --report-stylesheet workflow/report/style.css -- all $(wildcard $(RESULTS)/figures/arm_*.png)

article: tools all ## the article, results/article.pdf
	$(SNAKEMAKE) -- results/article.pdf

archive: report article ## code, results, recordings and article in one file, results/archive.zip
	.venv/bin/python -m workflow.archive results/archive.zip

reproduce: archive ## unpack the archive elsewhere, and check that it reproduces its results (5 minutes)
	$(ELSEWHERE) && archive="$$PWD/results/archive.zip" && cd "$$folder" && $(PYTHON) -m zipfile --extract "$$archive" . && \
	  cd recalib-* && make PYTHON=$(PYTHON) CORES=$(CORES) && cd results && sha256sum --check --quiet ../published/SHA256SUMS

docs: tools ## these pages and a reference as a site, results/site/index.html
	NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --quiet --strict
	@echo "the site: results/site/index.html"

pictures: setup ## pictures before and after, and a film; SCENARIO=NAME for another one; needs a Vulkan driver such as mesa-vulkan-drivers
	$(SNAKEMAKE) --forcerun before_and_after film -- \
	  $(if $(SCENARIO),$(addprefix $(RESULTS)/figures/$(SCENARIO),_before.png .webp),pictures)

view: setup ## open a recording; make view SCENARIO=noise or STUDY=ur3 opens another one
	$(NO_SUCH)
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
# with CI, the viewer collects and sends no statistics
	CI=true .venv/bin/rerun --bind 127.0.0.1 --new $(RECORDING) \
	  || { echo "No display for a window here? make web shows the same in a browser."; exit 1; }

web: setup ## show recordings and report in a browser, also from a server; SCENARIO and STUDY as for make view
	$(NO_SUCH)
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
	.venv/bin/python -m workflow.watch $(RESULTS) --port $(PORT)

notebook: .venv/extras ## damage an arm with sliders, in a browser
	MARIMO_SKIP_UPDATE_CHECK=1 .venv/bin/marimo run --host 127.0.0.1 --port $(PORT) examples/notebook.py

tune: setup ## repeat all searches for widths and rates, and ship what is found (an hour)
	$(SNAKEMAKE) tune
	cp results/search/*.csv workflow/search/

design: setup ## draw the universes anew, and ship them
	$(SNAKEMAKE) --forcerun design -- results/universes/design.csv
	mkdir -p workflow/universes/second
	cp results/universes/design.csv workflow/universes/second/

power: setup ## simulate campaigns whose true effects are known, and ship what the model finds (10 minutes)
	$(SNAKEMAKE) -- results/universes/power.csv
	cp results/universes/power.csv workflow/universes/second/

reference: setup ## measure the reference study as the universes are, and ship it (40 minutes)
	$(SNAKEMAKE) -- results/universes/reference.csv results/universes/efforts.csv
	cp results/universes/reference.csv results/universes/efforts.csv workflow/universes/second/

universes: setup ## measure all universes of the design, or PIECE=0 or 1 of them, and ship them (half an hour a piece)
	$(SNAKEMAKE) $(if $(PIECE),-- results/universes/outcomes_$(PIECE).csv,universes)
	cp results/universes/outcomes_$(or $(PIECE),*).csv workflow/universes/second/

horizons: setup ## how long Ritter's map takes in universes, or in PIECE=0 to 3 of them (half an hour a piece)
	$(SNAKEMAKE) $(if $(PIECE),-- results/universes/horizon_$(PIECE).csv,horizons)
	cp results/universes/horizon_$(or $(PIECE),*).csv workflow/universes/second/

ship: setup ## make the present config.yaml the shipped study
	.venv/bin/python -m recalib.study.studies

lock: tools ## pin the dependencies of pyproject.toml anew
	$(LOCK) --extra study --output-file requirements.lock
	$(LOCK) $(addprefix --extra ,study dev docs article) --constraint requirements.lock --output-file requirements-dev.lock
	$(LOCK) $(addprefix --extra ,study vision live cluster notebook mutants) --constraint requirements-dev.lock \
	  --output-file requirements-extras.lock

clean: ## remove results, keep the environment
	rm -rf results .snakemake
