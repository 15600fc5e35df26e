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
# prints one line for each new file, and errors
BRIEFLY = --quiet rules reason host progress
RECORDINGS = $(RESULTS)/recordings
RECORDING = $(firstword $(SCENARIO:%=$(RECORDINGS)/%.rrd) \
  $(wildcard $(RECORDINGS)/links_encoders.rrd $(RECORDINGS)/*.rrd) $(RECORDINGS)/links_encoders.rrd)
FILMED = $(or $(SCENARIO),links_encoders)
PIP = .venv/bin/python -m pip install --quiet --disable-pip-version-check
UV = .venv/bin/uv --quiet --no-python-downloads
PYTEST = .venv/bin/python -m pytest
LOCK = .venv/bin/uv pip compile pyproject.toml --universal --generate-hashes --no-emit-index-url \
  --python-version 3.11 --custom-compile-command "make lock"
# container images often disable Python's cache of compiled modules: each job would compile again
export PYTHONDONTWRITEBYTECODE =
ELSEWHERE = folder=$$(mktemp -d) && trap 'rm -r "$$folder"' EXIT

.PHONY: all help quick study setup tools cluster vision live lint lines test test-all dist elsewhere lowest slurm faults mutants peers witness check bench latency article archive reproduce docs film view web notebook tune design campaign ship lock clean

all: setup ## run the full replication
	$(SNAKEMAKE) $(BRIEFLY)

help: ## print this list
	@sed -n 's/^\([a-z-]*\):.*## /\1|/p' $(MAKEFILE_LIST) | tr '|' '\t' | expand -t 12

quick: STUDY = quick
quick: study ## run a small replication, in two minutes including the set-up: results/studies/quick

study: setup ## run your own study or one in workflow/studies: make study STUDY=my_arm; see docs/bend.md
	$(NO_SUCH)
	@.venv/bin/python -m replication.config.reading $(STUDY_FILE)
	$(SNAKEMAKE) $(BRIEFLY)

setup: .venv/installed ## install the packages for studies, from requirements.lock

tools: .venv/tools ## install the packages for tests, pages and the article, from requirements-dev.lock

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

cluster: .venv/extras ## install Snakemake's plugin for Slurm, from requirements-extras.lock; see docs/cluster.md

vision: .venv/extras ## install OpenCV for pictures of a board, from requirements-extras.lock; see docs/pictures.md

live: .venv/extras ## install MuJoCo for an arm with dynamics, from requirements-extras.lock; see docs/live_paper.md

.venv/extras: .venv/installed requirements-extras.lock
	$(PIP) --require-hashes -r requirements-extras.lock
	touch $@

test: lint ## run the linters and all tests except whole workflows, examples, sites, environments and simulations
	$(PYTEST) -m "not slow"

test-all: lint ## run the linters and all tests
	$(PYTEST)

lint: tools ## run the linters and the type checker
	.venv/bin/ruff check .
	.venv/bin/ruff format --check .
	.venv/bin/mypy
	.venv/bin/lint-imports
	.venv/bin/snakefmt --check Snakefile workflow/rules

lines: ## count the lines of Python code
	@for part in recalib replication workflow tests; do echo "$$part: $$(git ls-files "$$part/*.py" | xargs cat | wc -l)"; done

dist: tools ## build the release, sources and wheel, in dist/
	rm -rf dist
	.venv/bin/python -m build --no-isolation --outdir dist
	.venv/bin/twine check --strict dist/*

elsewhere: dist ## unpack the release in a temporary folder, and run make test and make quick there; PYTHON=python3.13 for another Python
	$(ELSEWHERE) && tar --extract --file dist/recalib-*.tar.gz --directory "$$folder" --strip-components 1 && \
	  make --directory "$$folder" PYTHON=$(PYTHON) test quick

lowest: tools ## run the library's tests with the lowest versions that pyproject.toml allows
	$(ELSEWHERE) && $(UV) venv --python .venv/bin/python "$$folder" && \
	  $(UV) pip install --python "$$folder" --resolution lowest-direct .[laboratory,study,vision,dev] && \
	  "$$folder/bin/python" -m pytest -m "not slow" $(addprefix tests/,damaged identification laboratory learners nominal vision/test_boards.py vision/test_patterns.py)

slurm: tools ## run a small campaign on a Slurm cluster of one node, with faults; reports missing programs
	.venv/bin/python -m pytest -n0 -rs tests/slurm

faults: tools ## kill runs and commands, start two at once, damage and mistype files, fill the disk (12 minutes)
	.venv/bin/python -m pytest -n0 -vv -rs tests/faults

mutants: tools .venv/extras ## plant small random errors in the code, and list those that no test detects, with the time left: docs/mutants.md
	.venv/bin/python -m tests.mutants --count $(COUNT)

peers: tools ## compare our calibration with figaroh and robotkinecal, each in its own environment: docs/peers.md
	.venv/bin/python -m tests.peers $(addprefix --recording ,$(RECORDED))

witness: setup ## train variants of three setups with a second, independent implementation, and compare (30 minutes)
	.venv/bin/python -m tests.bars.witness config.yaml workflow/campaign/design.csv workflow/campaign/outcomes.csv 0 1 2

check: setup ## only compare the final errors with their bands
	$(SNAKEMAKE) --forcerun check -- $(RESULTS)/check.txt

bench: setup ## measure the time of a move, with and without learning
	$(SNAKEMAKE) --quiet rules reason host -- results/robots/ur10/links_encoders.json
	.venv/bin/python -m tests.bars.moves results/robots/ur10/links_encoders.json

latency: vision live ## measure the response times of a live calibration and of a corrected command
	.venv/bin/python -m tests.bars.latency

article: tools all ## typeset the article, results/article.pdf
	$(SNAKEMAKE) -- results/article.pdf

archive: article ## pack code, results, recordings and article into one file, results/archive.zip
	.venv/bin/python -m replication.pages.archive results/archive.zip

reproduce: archive ## unpack the archive in a temporary folder, and check that it reproduces its results (5 minutes)
	$(ELSEWHERE) && archive="$$PWD/results/archive.zip" && cd "$$folder" && $(PYTHON) -m zipfile --extract "$$archive" . && \
	  cd recalib-* && make PYTHON=$(PYTHON) CORES=$(CORES) && cd results && sha256sum --check --quiet ../published/SHA256SUMS

docs: tools ## build the pages and a reference as a site, results/site/index.html
	NO_MKDOCS_2_WARNING=1 .venv/bin/python -m mkdocs build --quiet --strict
	@echo "the site: results/site/index.html"

film: setup ## make a film of a recording; SCENARIO=NAME for another one; needs a Vulkan driver such as mesa-vulkan-drivers
	$(SNAKEMAKE) --forcerun film -- $(RESULTS)/figures/$(FILMED).webp
	$(if $(SCENARIO)$(filter-out replication,$(STUDY)),,cp results/figures/$(FILMED).webp figures/arm.webp)

view: setup ## open a recording; make view SCENARIO=links or STUDY=ur3 opens another one
	$(NO_SUCH)
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
# with CI=true, the viewer collects and sends no statistics
	CI=true .venv/bin/rerun --bind 127.0.0.1 --new $(RECORDING) \
	  || { echo "No display for a window here? make web shows the same in a browser."; exit 1; }

web: setup ## show a recording in a browser, also from a server; SCENARIO and STUDY as in make view
	$(NO_SUCH)
	$(SNAKEMAKE) --quiet all -- $(RECORDING)
	.venv/bin/python -m replication.recording.web_viewer $(RECORDING) $(RESULTS)/web
	.venv/bin/python -m http.server --bind 127.0.0.1 --directory $(RESULTS)/web $(PORT)

notebook: .venv/extras ## damage an arm with sliders, in a browser
	MARIMO_SKIP_UPDATE_CHECK=1 .venv/bin/marimo run --host 127.0.0.1 --port $(PORT) examples/notebook.py

tune: ## search again for the settings of every variant in the reference study, and ship them (an hour)
	$(MAKE) campaign SETUP=0

campaign: setup ## measure the missing setups of the campaign, or SETUP=N again, and ship them (half an hour on a core each)
	$(SNAKEMAKE) $(if $(SETUP),--forcerun outcomes -- results/campaign/outcomes/$(SETUP)/0.csv,campaign)
	.venv/bin/python -m replication.campaign.ship results/campaign/outcomes

design: setup ## draw the setups of the campaign again, and ship them
	$(SNAKEMAKE) --forcerun design -- results/campaign/design.csv
	cp results/campaign/design.csv workflow/campaign/

ship: setup ## make the current config.yaml the shipped study
	.venv/bin/python -m replication.running.studies

lock: tools ## update the pinned versions of all dependencies
	$(LOCK) --extra study --output-file requirements.lock
	$(LOCK) $(addprefix --extra ,study dev docs article) --constraint requirements.lock --output-file requirements-dev.lock
	$(LOCK) $(addprefix --extra ,study vision live cluster notebook mutants) --constraint requirements-dev.lock \
	  --output-file requirements-extras.lock

clean: ## remove results, keep the environment
	rm -rf results .snakemake
