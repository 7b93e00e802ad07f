"""Run the command line with ``python -m trundle``."""

from trundle.cli.app import main

if __name__ == "__main__":
    main()
