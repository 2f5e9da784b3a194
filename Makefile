# make run      run hough-tui; choose what with ARGS, for example: make run ARGS="sets"
# make test     lint, check types and import contracts, run the tests
# make check    the same with the fast tests alone
# make format   put the sources into the form that the checks ask for
#
# All need python3 (3.11 or newer) and make, nothing else. They set up a virtual environment in VENV
# by themselves, and again only when pyproject.toml has changed. `make run` installs what running
# needs; the others add the tools of development.

VENV ?= .venv
ARGS = batch course-report
FAST = tests/algorithms tests/scenarios tests/hough_tui/reports

python := $(VENV)/bin/python
ready := $(VENV)/.hough-tui-ready
ready_for_development := $(VENV)/.hough-tui-ready-for-development
install := $(python) -m pip install --quiet --quiet --disable-pip-version-check --editable

.PHONY: run test check format

run: $(ready)
	@$(VENV)/bin/hough-tui $(ARGS)

test: lint
	$(python) -m pytest -n 2 --dist loadfile

check: lint
	$(python) -m pytest -n 2 --dist loadfile --quiet $(FAST)

.PHONY: lint
lint: $(ready_for_development)
	$(python) -m ruff check .
	$(python) -m ruff format --check .
	$(python) -m mypy
	$(VENV)/bin/lint-imports

format: $(ready_for_development)
	$(python) -m ruff check --fix .
	$(python) -m ruff format .

# Each stamp is the last thing made, so an interrupted set-up is taken up again. An environment
# counts as made when it has its activate script (which comes last) and its pip runs.
$(ready): pyproject.toml
	@rm -f $@
	@base=$(python); \
	test -f $(VENV)/bin/activate && $$base -m pip --version >/dev/null 2>&1 || base=python3; \
	command -v $$base >/dev/null || \
		{ echo "make: python3 was not found; hough-tui needs Python 3.11 or newer" >&2; exit 1; }; \
	$$base -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "make: hough-tui needs Python 3.11 or newer; $$base is $$($$base --version 2>&1)" >&2; exit 1; }; \
	test $$base != python3 && exit; \
	python3 -c 'import ensurepip, venv' 2>/dev/null || \
		{ echo "make: python3 cannot make a virtual environment; on Debian or Ubuntu: apt install python3-venv" >&2; exit 1; }; \
	echo "Setting up $(VENV)" >&2; \
	rm -f $(python) $(python)3 $(python)3.*; \
	python3 -m venv $(VENV)
	@echo "Installing hough-tui into $(VENV)" >&2
	@$(install) .
	@touch $@

$(ready_for_development): $(ready)
	@echo "Installing the tools of development into $(VENV)" >&2
	@$(install) '.[dev]'
	@touch $@
