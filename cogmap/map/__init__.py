"""The cognitive map: what it learns, tells, keeps on disk, and loses by a lesion."""
