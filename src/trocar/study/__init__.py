"""Protocols, comparison, statistics, ledger and report."""
