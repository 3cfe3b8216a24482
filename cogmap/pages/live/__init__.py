"""The page: an explorer that one can watch look, dream and go, live in a browser, frozen in a file, or filmed."""
