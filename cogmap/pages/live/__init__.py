"""The page: an explorer that looks, dreams and goes, live in a browser, frozen in a file, or filmed."""
