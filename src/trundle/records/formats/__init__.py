"""Binary formats of records: a file each, found by being here.

A file has one value ``FORMAT``; what no format claims is read as text (`trundle.records.table`).
"""
